#include "object_modelling/registration/support_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace object_modelling::registration
{
namespace
{
constexpr double LOWEST_SHARE = 0.01;  // of the points: noise reaches lower
}

LowestPoint lowestPoint(const MatchedSurface& part, const Eigen::Isometry3f& T_plane_part, const geometry::Plane& plane)
{
  const Eigen::Vector3f n = T_plane_part.linear().transpose() * plane.normal.cast<float>();
  const auto offset = static_cast<float>(plane.signedDistance_m(T_plane_part.translation().cast<double>()));
  std::vector<std::pair<float, int>> heights;
  if (part.fine_samples.empty())
    return {};
  heights.reserve(part.fine_samples.size());
  for (const int i : part.fine_samples)
    heights.emplace_back(n.dot(part.model.points[i]) + offset, i);
  const auto at = heights.begin() + static_cast<std::ptrdiff_t>(LOWEST_SHARE * static_cast<double>(heights.size()));
  std::nth_element(heights.begin(), at, heights.end());
  return { part.model.points[at->second], at->first };
}

double contactGap_m(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b)
{
  float gap_m = 0;
  if (a.model.support_plane)
    gap_m = std::abs(lowestPoint(b, T_a_b, *a.model.support_plane).height_m);
  if (b.model.support_plane)
    gap_m = std::max(gap_m, std::abs(lowestPoint(a, T_a_b.inverse(), *b.model.support_plane).height_m));
  return gap_m;
}

}  // namespace object_modelling::registration
