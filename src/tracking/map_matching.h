#pragma once

#include <unordered_map>
#include <vector>

#include "keyframe_map.h"
#include "object_modelling/registration/image_pyramid.h"
#include "object_modelling/registration/pose_estimation.h"

namespace object_modelling::tracking
{
/// A landmark found in the current frame.
struct LandmarkMatch
{
  std::uint64_t landmark_id = 0;
  registration::Correspondence correspondence;
  bool trusted = true;  ///< its place comes from a trusted keyframe
};

std::vector<LandmarkMatch> inliersOf(const std::vector<LandmarkMatch>& matches, const registration::PoseEstimate& pose);
std::vector<registration::Correspondence> correspondencesOf(const std::vector<LandmarkMatch>& matches);

struct MapMatches
{
  std::vector<LandmarkMatch> matches;
  int predicted_count = 0;     ///< landmarks that should be in view
  double reference_share = 0;  ///< found ones of the nearest keyframe, as a share of all that it sees
};

struct MapMatchingOptions
{
  std::size_t reference_count = 2;  ///< nearest keyframes whose patches are looked for
  int max_matches = 400;
  double prediction_error_px = 1.5;  ///< expected, of the pose given
};

/// Projective patch refinement (Aldoma et al. 2015, section 3.1): the landmarks of the nearest keyframes, predicted by
/// a pose, found sub-pixel by their warped patches. `flow_pixels`: pixels by optical flow, better starts where there
/// are any.
MapMatches matchMap(const KeyframeMap& map, const rgbd::Frame& frame, const registration::ImagePyramid& pyramid,
                    const Eigen::Isometry3d& T_session_camera,
                    const std::unordered_map<std::uint64_t, Eigen::Vector2f>& flow_pixels,
                    const MapMatchingOptions& options);

}  // namespace object_modelling::tracking
