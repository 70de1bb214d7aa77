#pragma once

#include <vector>

#include <Eigen/Geometry>

namespace object_modelling::geometry
{
/// Points p with normal . p + offset_m = 0; normal of unit length. A support plane's normal points away from the
/// support, up to the object, so signedDistance() is the height above it.
struct Plane
{
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0;

  double signedDistance_m(const Eigen::Vector3d& p) const { return normal.dot(p) + offset_m; }
};

/// The plane given in frame b, expressed in frame a.
Plane transformed(const Eigen::Isometry3d& T_a_b, const Plane& plane_b);

/// Total-least-squares plane through points; false for fewer than 3 or collinear ones. Normal sign is towards
/// `viewpoint`.
bool fitPlane(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& viewpoint, Plane* plane);

}  // namespace object_modelling::geometry
