#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "object_modelling/base/status.h"

namespace object_modelling::base
{
/// Collects every broken bound of an options struct, so that a user mends all of them at once.
///
///   std::vector<std::string> Options::violations() const
///   {
///     OptionsCheck check("camera_tracker");
///     check.inRange("min_inlier_ratio", min_inlier_ratio, 0.0, 1.0);
///     return check.violations();
///   }
class OptionsCheck
{
public:
  explicit OptionsCheck(std::string owner) : owner_(std::move(owner)) {}

  template <typename T>
  void inRange(const std::string& field, const T& value, const T& low, const T& high)
  {
    if (!(value >= low && value <= high))
      add(field, value, "must be within [" + text(low) + ", " + text(high) + "]");
  }
  template <typename T>
  void positive(const std::string& field, const T& value)
  {
    if (!(value > T(0)))
      add(field, value, "must be greater than 0");
  }
  template <typename T>
  void atLeast(const std::string& field, const T& value, const T& low)
  {
    if (!(value >= low))
      add(field, value, "must be at least " + text(low));
  }
  /// Takes over the violations of a nested options struct.
  void include(const std::vector<std::string>& nested)
  {
    violations_.insert(violations_.end(), nested.begin(), nested.end());
  }
  void require(const std::string& field, bool holds, const std::string& what)
  {
    if (!holds)
      violations_.push_back(owner_ + "/" + field + ": " + what);
  }
  const std::vector<std::string>& violations() const { return violations_; }

private:
  template <typename T>
  static std::string text(const T& value)
  {
    std::ostringstream out;
    out << value;
    return out.str();
  }
  template <typename T>
  void add(const std::string& field, const T& value, const std::string& bound)
  {
    violations_.push_back(owner_ + "/" + field + " = " + text(value) + ": " + bound);
  }

  std::string owner_;
  std::vector<std::string> violations_;
};

/// Throws one base::Error (INVALID_ARGUMENT) that lists all violations; for constructors.
template <typename Options>
const Options& checked(const Options& options)
{
  const std::vector<std::string> violations = options.violations();
  if (violations.empty())
    return options;
  std::string message = "invalid options:";
  for (const std::string& violation : violations)
    message += "\n  " + violation;
  throw Error(StatusCode::INVALID_ARGUMENT, message);
}

}  // namespace object_modelling::base
