#pragma once

#include <optional>

#include "object_modelling/bundle_adjustment/keyframe_linker.h"
#include "object_modelling/features/keyframe_features.h"

namespace object_modelling::bundle_adjustment
{
/// Matches two keyframes and keeps the result only if it is sure: enough 3-D inliers of the RANSAC motion for the
/// number of matches, spread over the surface, and surfaces that do not see through each other under that motion.
std::optional<VerifiedLink> verifyLink(const std::vector<rgbd::Keyframe>& keyframes,
                                       const std::vector<features::KeyframeFeatures>& features, int a, int b,
                                       const KeyframeLinkerOptions& options);

/// Share of the surface seen by both where `from`'s surface lies in front of `onto`'s although `onto` should see it (or
/// outside onto's object mask, with `object_only`): free-space violations by violations and agreements. 1 where nothing
/// is seen by both.
double violationRatio(const rgbd::Frame& from, const rgbd::Frame& onto, const Eigen::Isometry3d& T_onto_from,
                      bool object_only);

}  // namespace object_modelling::bundle_adjustment
