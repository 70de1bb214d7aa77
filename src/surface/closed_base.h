#pragma once

#include <vector>

#include <Eigen/Core>

#include "object_modelling/geometry/plane.h"

namespace object_modelling::surface
{
/// Adds points, `step_m` apart and facing down, where an object of these points stands on its support: within the hull
/// of what is near the plane. Nothing where the object touches it in too few points.
void addBase(const geometry::Plane& support, double step_m, std::vector<Eigen::Vector3f>* points,
             std::vector<Eigen::Vector3f>* normals);

}  // namespace object_modelling::surface
