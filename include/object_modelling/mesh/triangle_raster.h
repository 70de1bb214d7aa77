#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::mesh
{
/// Shares of less than this count as on an edge.
constexpr float ON_EDGE_SHARE = 1e-4f;

/// Shares of the corners in a point of their plane, 1 in all; outside of the triangle some are negative. Those of the
/// first corner alone where the triangle has no area.
inline Eigen::Vector3f sharesAt(const std::array<Eigen::Vector2f, 3>& corners, const Eigen::Vector2f& p)
{
  const auto cross = [](const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); };
  const float area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (!(std::abs(area) > 0))
    return Eigen::Vector3f::UnitX();
  return { cross(corners[1] - p, corners[2] - p) / area, cross(corners[2] - p, corners[0] - p) / area,
           cross(corners[0] - p, corners[1] - p) / area };
}

/// Calls f(u, v, shares) for every pixel centre all of whose shares in the corners (which add up to 1) are at least
/// `least_share`: with +ON_EDGE_SHARE those strictly within the triangle, with -ON_EDGE_SHARE those on its edges too.
template <typename Function>
void forEachPixelInside(const std::array<Eigen::Vector2f, 3>& corners, float least_share, const cv::Size& size,
                        const Function& f)
{
  if (sharesAt(corners, corners[1]) == Eigen::Vector3f::UnitX())  // no area
    return;
  const auto low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).eval();
  const auto high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).eval();
  const int u_last = std::min(size.width - 1, static_cast<int>(std::floor(high.x())));
  const int v_last = std::min(size.height - 1, static_cast<int>(std::floor(high.y())));
  for (int v = std::max(0, static_cast<int>(std::ceil(low.y()))); v <= v_last; ++v)
    for (int u = std::max(0, static_cast<int>(std::ceil(low.x()))); u <= u_last; ++u)
    {
      const Eigen::Vector3f shares = sharesAt(corners, { static_cast<float>(u), static_cast<float>(v) });
      if (shares.minCoeff() >= least_share)
        f(u, v, shares);
    }
}

}  // namespace object_modelling::mesh
