#pragma once

#include "object_modelling/registration/matched_surface.h"

namespace object_modelling::registration
{
struct LowestPoint
{
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  ///< in the frame of the part
  float height_m = 0;                               ///< above the plane; below it is only noise
};
/// At height 0 if the part has no points.
LowestPoint lowestPoint(const MatchedSurface& part, const Eigen::Isometry3f& T_plane_part,
                        const geometry::Plane& plane);

/// How far (m) the lowest points of either part are off the other's support plane, the larger of both; 0 without
/// planes. Quick: what cannot stand there is sorted out by it.
double contactGap_m(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b);

}  // namespace object_modelling::registration
