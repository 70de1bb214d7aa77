#pragma once

#include <vector>

#include "bundle_solver.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::bundle_adjustment
{
/// Covariance of every pose (as geometry::Matrix6d defines it) with the landmarks marginalised out: inverse of the
/// reduced camera system, times the variance of the residuals, at the solution of solveBundle. Zero for the fixed
/// keyframe, for keyframes without sights, and for all if the system is singular.
std::vector<geometry::Matrix6d> poseCovariances(const std::vector<rgbd::Keyframe>& keyframes, int fixed_keyframe,
                                                double loss_width_sigmas, const BundleState& state);

}  // namespace object_modelling::bundle_adjustment
