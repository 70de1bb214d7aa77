#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace object_modelling::object_properties
{
/// Where one region of a hull meets another.
struct RegionBorder
{
  std::size_t other = 0;       ///< region beyond
  double overhang_m = 0;       ///< of the centre of mass beyond the edge, seen along the region's normal
  double edge_distance_m = 0;  ///< of the centre of mass from the edge: its height while the object tips over it
};

/// Facets of a convex hull that are coplanar within a tolerance: what an object can lie on.
struct HullRegion
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward, unit length, of the facets by their area
  double height_m = 0;                               ///< of the centre of mass above the plane that touches the hull
  double solid_angle_ratio = 0;                      ///< of the whole sphere, seen from the centre of mass
  bool stable = false;                               ///< the centre of mass stands over the region
  std::vector<RegionBorder> borders;
};

/// None for points without volume. Facets join the largest one near them whose normal is as near as that.
std::vector<HullRegion> hullRegions(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& center_of_mass_m,
                                    double max_coplanar_rad);

}  // namespace object_modelling::object_properties
