#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
/// One sight of a landmark in a keyframe.
struct Observation
{
  std::uint64_t landmark_id = 0;  ///< unique within a session
  Eigen::Vector2f pixel{ 0, 0 };  ///< sub-pixel position
  float depth_m = 0;              ///< NaN where the depth image has none there
};

/// A frame that is kept. Its frame's object_mask is empty until the object has been segmented; its moving_mask unless
/// it was tracked on the object.
struct Keyframe
{
  int id = -1;  ///< counts from 0 within its session
  Frame frame;
  Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of T_session_camera; zero where not known
  std::vector<Observation> observations;
};

}  // namespace object_modelling::rgbd
