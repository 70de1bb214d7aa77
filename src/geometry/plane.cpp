#include "object_modelling/geometry/plane.h"

#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::geometry
{
Plane transformed(const Eigen::Isometry3d& T_a_b, const Plane& plane_b)
{
  Plane plane_a;
  plane_a.normal = T_a_b.linear() * plane_b.normal;
  plane_a.offset_m = plane_b.offset_m - plane_a.normal.dot(T_a_b.translation());
  return plane_a;
}

bool fitPlane(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& viewpoint, Plane* plane)
{
  if (points.size() < 3)
    return false;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points)
    mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points)
    moments += (p - mean) * (p - mean).transpose();
  if (!moments.allFinite())
    return false;
  const EigenSystem<3> system = eigenSystem(moments);
  if (!(system.values[1] > 1e-12 * system.values[2]))
    return false;
  plane->normal = system.vectors.col(0).normalized();
  if (plane->normal.dot(viewpoint - mean) < 0)
    plane->normal = -plane->normal;
  plane->offset_m = -plane->normal.dot(mean);
  return true;
}

}  // namespace object_modelling::geometry
