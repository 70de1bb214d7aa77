#pragma once

#include <vector>

#include "landmark_map.h"
#include "object_modelling/bundle_adjustment/keyframe_linker.h"
#include "pose_graph.h"

namespace object_modelling::bundle_adjustment
{
/// Drift of one tracked step or match, as share of the distance to the surface.
constexpr double DRIFT_RATIO = 0.004;

/// Edge of a link: its own T_a_b, its own points.
PoseEdge edgeOfLink(const VerifiedLink& link, const std::vector<rgbd::Keyframe>& keyframes);

/// One edge, with the relative pose that the tracker found, for every pair that shares at least `min_shared` landmarks.
std::vector<PoseEdge> edgesOfTracker(const std::vector<SightGroup>& groups,
                                     const std::vector<rgbd::Keyframe>& keyframes, int min_shared);

/// Relaxes the pose graph of tracker and links, drops the link that fits worst, and again until all that remain fit
/// within the drift that tracking can have had. Clears the dropped ones in `active`; returns the relaxed poses.
std::vector<Eigen::Isometry3d> relaxWithLinks(const std::vector<PoseEdge>& tracker_edges,
                                              const std::vector<PoseEdge>& link_edges, int fixed,
                                              const std::vector<Eigen::Isometry3d>& T_session_camera,
                                              std::vector<bool>* active);

/// Whether most points of a link still agree with the given poses.
bool supports(const VerifiedLink& link, const std::vector<rgbd::Keyframe>& keyframes,
              const std::vector<Eigen::Isometry3d>& T_session_camera);

}  // namespace object_modelling::bundle_adjustment
