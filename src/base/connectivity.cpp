#include "object_modelling/base/connectivity.h"

#include <algorithm>

namespace object_modelling::base
{
std::vector<std::vector<int>> components(const Eigen::MatrixXi& shared, int min_shared)
{
  const int count = static_cast<int>(shared.rows());
  std::vector<bool> visited(count, false);
  std::vector<std::vector<int>> found;
  for (int seed = 0; seed < count; ++seed)
  {
    if (visited[seed])
      continue;
    std::vector<int> component{ seed };
    visited[seed] = true;
    for (std::size_t next = 0; next < component.size(); ++next)
    {
      for (int other = 0; other < count; ++other)
      {
        if (visited[other] || shared(component[next], other) < min_shared)
          continue;
        visited[other] = true;
        component.push_back(other);
      }
    }
    std::sort(component.begin(), component.end());
    found.push_back(std::move(component));
  }
  return found;
}

std::vector<int> largestComponent(const Eigen::MatrixXi& shared, int min_shared)
{
  std::vector<int> largest;
  for (std::vector<int>& component : components(shared, min_shared))
    if (component.size() > largest.size())
      largest = std::move(component);
  return largest;
}

}  // namespace object_modelling::base
