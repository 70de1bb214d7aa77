#pragma once

#include "feature_detector.h"
#include "keyframe_map.h"
#include "map_matching.h"

namespace object_modelling::tracking
{
/// A new keyframe for the map and for those who keep it.
struct NewKeyframe
{
  MapKeyframe map;
  rgbd::Keyframe keyframe;
};

/// Makes a keyframe of a tracked frame: `matches` become further sightings of their landmarks, and new landmarks (ids
/// from *next_landmark_id on) are detected where there is room. Only places with depth and a normal become sightings.
NewKeyframe makeKeyframe(int id, const rgbd::Frame& frame, const registration::ImagePyramid& pyramid,
                         const Eigen::Isometry3d& T_session_camera, const std::vector<LandmarkMatch>& matches,
                         bool object_only, const FeatureDetectorOptions& options, std::uint64_t* next_landmark_id);

}  // namespace object_modelling::tracking
