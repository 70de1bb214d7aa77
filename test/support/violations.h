#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace object_modelling::test_support
{
/// Names of what a check of options found broken, sorted: of "group/name = value: reason", the name.
inline std::vector<std::string> namesOf(const std::vector<std::string>& violations)
{
  std::vector<std::string> names;
  for (const std::string& violation : violations)
  {
    const std::string left = violation.substr(0, violation.find_first_of(" :"));
    names.push_back(left.substr(left.find_last_of('/') + 1));
  }
  std::sort(names.begin(), names.end());
  return names;
}
}  // namespace object_modelling::test_support
