#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/geometry/convex_hull.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::object_properties
{
/// Triangles by their corners, metres.
using Soup = std::vector<std::array<Eigen::Vector3f, 3>>;

Soup soupOf(const mesh::TriangleMesh& mesh);
/// With corners joined on a grid, so that there are few: for a search.
Soup coarsened(const Soup& soup, float cell_m);
/// What lies where the coordinate `axis` is below (`side` < 0) or above `at_m`.
Soup clipped(const Soup& soup, int axis, float at_m, int side);
Soup clipped(const Soup& soup, const Eigen::AlignedBox3f& box);
std::vector<Eigen::Vector3f> cornersOf(const Soup& soup);

/// Deepest place of a surface under its convex hull, measured along the surface's normal.
struct Hollow
{
  double depth_m = 0;
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};
/// The deepest but for the two percent of the surface that are deeper still.
Hollow deepestHollow(const Soup& soup, const geometry::HullSurface& hull);

}  // namespace object_modelling::object_properties
