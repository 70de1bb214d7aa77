#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/source/trajectory_file.h"

namespace object_modelling::source
{
/// Carries refined keyframe poses over to all frames of a session. Between two keyframes (in time) a frame keeps the
/// pose that it had relative to either, interpolated by time, so that at a keyframe it meets the refined pose exactly;
/// before the first and after the last the nearest keyframe alone counts. `keyframe_stamps_s` must be strictly
/// ascending and as many as `before` and `after`; throws base::Error (INVALID_ARGUMENT) otherwise. Without keyframes
/// the trajectory is returned unchanged.
std::vector<source::StampedPose> correctTrajectory(const std::vector<source::StampedPose>& live,
                                                   const std::vector<double>& keyframe_stamps_s,
                                                   const std::vector<Eigen::Isometry3d>& before,
                                                   const std::vector<Eigen::Isometry3d>& after);

}  // namespace object_modelling::source
