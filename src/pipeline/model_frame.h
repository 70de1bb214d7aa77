#pragma once

#include <optional>
#include <vector>

#include "object_modelling/geometry/oriented_box.h"
#include "object_modelling/geometry/plane.h"

namespace object_modelling::pipeline
{
/// Box of the object in the reference frame. With a support plane it stands on it: z up, and the box reaches down to
/// the plane where the lowest points are close to it, since segmentation leaves out what is too near the table to
/// separate from it. Without one it is the smallest box of the hull, z along the axis that was nearest to the first
/// camera's up.
geometry::OrientedBox objectBox(const std::vector<Eigen::Vector3f>& points_reference,
                                const std::optional<geometry::Plane>& support_plane_reference);

/// Largest distance between two points, among the extreme points of many directions (error well below 0.1 %).
double diameter_m(const std::vector<Eigen::Vector3f>& points);

}  // namespace object_modelling::pipeline
