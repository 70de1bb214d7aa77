#pragma once

#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/keyframe.h"
#include "pose_graph.h"

namespace object_modelling::bundle_adjustment
{
/// Two keyframes, by index, whose surfaces have been aligned.
struct SurfaceLink
{
  int a = -1, b = -1;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  geometry::Matrix6d information = geometry::Matrix6d::Zero();  ///< of a motion on the left of T_a_b
  /// Grey levels take part, so that T_a_b depends on how far the colour images are shifted against depth: motion on its
  /// left per pixel of shift beyond color_offset_px.
  Eigen::Matrix<double, 6, 2> by_color_offset = Eigen::Matrix<double, 6, 2>::Zero();
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();  ///< for which T_a_b was found
};

/// Aligns neighbours in time, and each keyframe with those that by the poses see most of the same, in both directions:
/// a link needs both to agree. They constrain scenes without texture. by_color_offset only if asked for.
std::vector<SurfaceLink> linkSurfaces(const std::vector<rgbd::Keyframe>& keyframes,
                                      const Eigen::Vector2d& color_offset_px, bool find_by_color_offset,
                                      bool object_only, base::JobControl& control);

/// The same as an edge of the pose graph.
PoseEdge edgeOfSurfaces(const SurfaceLink& link, const std::vector<rgbd::Keyframe>& keyframes);

}  // namespace object_modelling::bundle_adjustment
