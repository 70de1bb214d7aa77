#pragma once

#include <optional>
#include <string>

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <object_modelling/TrackingState.h>
#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

namespace object_modelling::nodes
{
/// Where the session frame is (by tf), and which session is recorded (by the camera tracker's state). Not thread safe,
/// but for tf's own thread.
class SessionFrame
{
public:
  SessionFrame(ros::NodeHandle& node, const std::string& frame_id, double tf_timeout_s);

  /// Session being recorded; empty when none is.
  const std::string& recorded() const { return recorded_; }
  /// Nothing while no session is recorded, or the tracker has no pose at that time.
  std::optional<Eigen::Isometry3d> T_session_camera(const std_msgs::Header& camera) const;

  /// Pose and point given in any frame, in the camera's frame at its stamp. Throws base::Error (INVALID_ARGUMENT, or
  /// FAILED_PRECONDITION without a transform in tf).
  Eigen::Isometry3d inCamera(const geometry_msgs::PoseStamped& box, const std_msgs::Header& camera) const;
  Eigen::Vector3d inCamera(const geometry_msgs::PointStamped& point, const std_msgs::Header& camera) const;

private:
  Eigen::Isometry3d T_camera_source(const std_msgs::Header& source, const std_msgs::Header& camera) const;

  std::string frame_id_;
  ros::Duration tf_timeout_;
  std::string recorded_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  ros::Subscriber state_;
};

}  // namespace object_modelling::nodes
