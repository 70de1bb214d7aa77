#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace object_modelling::base
{
/// The upper median: of an even number of values the greater of the middle two. Zero without values; they are
/// reordered.
template <typename Value>
Value median(std::vector<Value>* values)
{
  if (values->empty())
    return Value(0);
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

/// The value that a share in [0, 1] of the others does not exceed, of the values themselves: the lower one of two
/// between which the place lies. Zero without values.
template <typename Value>
Value quantile(std::vector<Value> values, double share)
{
  if (values.empty())
    return Value(0);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of the values' distances from their median, scaled to the standard deviation of a normal distribution (MAD).
template <typename Value>
Value robustDeviation(std::vector<Value> values)
{
  const Value middle = median(&values);
  for (Value& value : values)
    value = value > middle ? value - middle : middle - value;
  return static_cast<Value>(1.4826) * median(&values);
}

}  // namespace object_modelling::base
