#include "observation_grid.h"

#include <algorithm>
#include <utility>

namespace object_modelling::fusion
{
namespace
{
constexpr int AXIS_BITS = 21;
constexpr int AXIS_HALF = 1 << (AXIS_BITS - 1);

}  // namespace

ObservationGrid::ObservationGrid(const std::vector<std::vector<Observation>>& observations_per_view, float cell_size_m)
    : cells_per_m_(1 / cell_size_m)
{
  std::size_t count = 0;
  for (const auto& observations : observations_per_view)
    count += observations.size();
  std::vector<Observation> unsorted;
  unsorted.reserve(count);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(count);
  for (const auto& observations : observations_per_view)
  {
    for (const Observation& observation : observations)
    {
      const Eigen::Array3i cell = cellOf(observation.point.array());
      order.emplace_back(keyOf(cell.x(), cell.y(), cell.z()), static_cast<std::uint32_t>(unsorted.size()));
      unsorted.push_back(observation);
    }
  }
  std::sort(order.begin(), order.end());

  observations_.reserve(count);
  for (const auto& [key, index] : order)
  {
    if (cell_keys_.empty() || cell_keys_.back() != key)
    {
      cell_keys_.push_back(key);
      cell_starts_.push_back(static_cast<std::uint32_t>(observations_.size()));
    }
    observations_.push_back(unsorted[index]);
  }
  cell_starts_.push_back(static_cast<std::uint32_t>(observations_.size()));
}

std::uint64_t ObservationGrid::keyOf(int x, int y, int z)
{
  const auto field = [](int value)
  { return static_cast<std::uint64_t>(std::clamp(value, -AXIS_HALF, AXIS_HALF - 1) + AXIS_HALF); };
  return (field(z) << (2 * AXIS_BITS)) | (field(y) << AXIS_BITS) | field(x);
}

void ObservationGrid::findRun(int x_low, int x_high, int y, int z, std::uint32_t* begin, std::uint32_t* end) const
{
  const auto first = std::lower_bound(cell_keys_.begin(), cell_keys_.end(), keyOf(x_low, y, z));
  auto last = first;
  const std::uint64_t high = keyOf(x_high, y, z);
  while (last != cell_keys_.end() && *last <= high)
    ++last;
  *begin = cell_starts_[static_cast<std::size_t>(first - cell_keys_.begin())];
  *end = cell_starts_[static_cast<std::size_t>(last - cell_keys_.begin())];
}

}  // namespace object_modelling::fusion
