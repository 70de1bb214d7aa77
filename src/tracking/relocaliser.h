#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "keyframe_map.h"
#include "object_modelling/registration/pose_estimation.h"

namespace object_modelling::tracking
{
struct RelocaliserOptions
{
  FeatureKind features = FeatureKind::ROBUST;
  /// Keyframes whose features may be made in one call; the others have their turn in the next.
  int max_detections = std::numeric_limits<int>::max();
  int min_inliers = 15;
  double min_inlier_ratio = 0.25;  ///< of the matches
  double max_reprojection_error_px = 3.0;
  double min_depth_agreement_ratio = 0.6;  ///< share of the keyframe's visible landmarks whose depth the frame confirms
  std::size_t near_candidates = 4;         ///< keyframes near the last known pose ...
  std::size_t similar_candidates = 4;      ///< ... and keyframes whose images are alike are tried
};

struct Relocalisation
{
  const MapKeyframe* keyframe = nullptr;  ///< the view that was recognised
  registration::PoseEstimate pose;
  std::string reason;  ///< why nothing was found
};

/// Places a frame without using the frames before it: wide-baseline features against keyframes, verified by geometry
/// (RANSAC with depth, then the depth of landmarks that played no part in it). `T_session_camera_hint` only orders the
/// candidates.
Relocalisation relocalise(const rgbd::Frame& frame, const KeyframeMap& map,
                          const std::optional<Eigen::Isometry3d>& T_session_camera_hint, std::uint64_t seed,
                          const RelocaliserOptions& options = {});

}  // namespace object_modelling::tracking
