#pragma once

#include <memory>
#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

#include "camera_tracker_options.h"

namespace object_modelling::nodes
{
/// Pose of the camera by the kinematics of the robot that carries it.
struct RobotPose
{
  std::optional<Eigen::Isometry3d> T_robot_camera;
  std::string problem;  ///< why there is none, the same as long as it lasts; empty if none is wanted
  std::string detail;   ///< more of it, with times
};

/// Asks tf where the camera is with respect to the robot. To be used by one thread; tf is heard in another.
class RobotMotion
{
public:
  explicit RobotMotion(const CameraTrackerNodeOptions& options);

  /// At the time of an image in frame `camera.frame_id`; waits for tf no longer than the options allow, by the
  /// wall clock.
  RobotPose at(const std_msgs::Header& camera) const;

private:
  bool hangsBelowSession() const;

  RobotOptions options_;
  std::string session_frame_id_;
  tf2_ros::Buffer buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;  ///< only if a robot is named: tf may be busy
};

}  // namespace object_modelling::nodes
