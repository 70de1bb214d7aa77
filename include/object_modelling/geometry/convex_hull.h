#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace object_modelling::geometry
{
struct ConvexHull
{
  std::vector<Eigen::Vector3f> vertices;  ///< in the frame and unit of the points
  std::vector<Eigen::Vector3d> normals;   ///< outward, one per face (coplanar facets merged)
};

/// Hull of the points (Qhull). Flat, collinear or fewer than 4 points have no volume: the normal of their plane (both
/// sides), or the x, y and z axes, and all points as vertices.
ConvexHull convexHull(const std::vector<Eigen::Vector3f>& points);

/// The hull as triangles, counter-clockwise seen from outside; its vertices are some of the points.
struct HullSurface
{
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  double volume_m3() const;
};

/// Hull of the points (Qhull); without triangles where they have no volume.
HullSurface hullSurface(const std::vector<Eigen::Vector3f>& points);

}  // namespace object_modelling::geometry
