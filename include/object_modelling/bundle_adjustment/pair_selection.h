#pragma once

#include <utility>
#include <vector>

#include "object_modelling/bundle_adjustment/keyframe_linker.h"
#include "object_modelling/features/keyframe_features.h"

namespace object_modelling::bundle_adjustment
{
using IndexPair = std::pair<int, int>;

/// Pairs (a < b, ascending) that are worth matching: see linkKeyframes.
std::vector<IndexPair> selectPairs(const std::vector<rgbd::Keyframe>& keyframes,
                                   const std::vector<features::KeyframeFeatures>& features,
                                   const Eigen::MatrixXi& shared, int enough_shared,
                                   const KeyframeLinkerOptions& options);

/// Share of a's surface (of its object, with `object_only`) that b sees too if the poses are right within some
/// decimetres, from a direction at most `max_view_angle_rad` off.
double predictedOverlap(const rgbd::Frame& a, const rgbd::Frame& b, const Eigen::Isometry3d& T_b_a,
                        const KeyframeLinkerOptions& options);
double predictedOverlap(const rgbd::Keyframe& a, const rgbd::Keyframe& b, const KeyframeLinkerOptions& options);

}  // namespace object_modelling::bundle_adjustment
