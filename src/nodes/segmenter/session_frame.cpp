#include "session_frame.h"

#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/names.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
namespace names = ros_bridge::names;

namespace
{
Eigen::Isometry3d fromTransform(const geometry_msgs::TransformStamped& target_from_source)
{
  geometry_msgs::Pose pose;
  pose.position.x = target_from_source.transform.translation.x;
  pose.position.y = target_from_source.transform.translation.y;
  pose.position.z = target_from_source.transform.translation.z;
  pose.orientation = target_from_source.transform.rotation;
  return ros_bridge::fromMessage(pose);
}
}  // namespace

SessionFrame::SessionFrame(ros::NodeHandle& node, const std::string& frame_id, double tf_timeout_s)
    : frame_id_(frame_id),
      tf_timeout_(tf_timeout_s),
      listener_(buffer_, node),
      state_(node.subscribe<object_modelling::TrackingState>(
          std::string(names::CAMERA_TRACKER) + "/" + names::STATE, 1,
          [this](const object_modelling::TrackingStateConstPtr& state)
          { recorded_ = state->recording ? state->session_id : std::string(); }))
{
}

std::optional<Eigen::Isometry3d> SessionFrame::T_session_camera(const std_msgs::Header& camera) const
{
  if (recorded_.empty())
    return std::nullopt;
  try
  {
    return fromTransform(buffer_.lookupTransform(frame_id_, camera.frame_id, camera.stamp, tf_timeout_));
  }
  catch (const tf2::TransformException&)
  {
    return std::nullopt;
  }
}

Eigen::Isometry3d SessionFrame::inCamera(const geometry_msgs::PoseStamped& box, const std_msgs::Header& camera) const
{
  return T_camera_source(box.header, camera) * ros_bridge::fromMessage(box.pose);
}

Eigen::Vector3d SessionFrame::inCamera(const geometry_msgs::PointStamped& point, const std_msgs::Header& camera) const
{
  const Eigen::Vector3d p_source(point.point.x, point.point.y, point.point.z);
  if (!p_source.allFinite())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "the point has coordinates that are not numbers");
  return T_camera_source(point.header, camera) * p_source;
}

Eigen::Isometry3d SessionFrame::T_camera_source(const std_msgs::Header& source, const std_msgs::Header& camera) const
{
  if (source.frame_id.empty())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "header.frame_id is empty: name a frame that tf knows, such as '" + camera.frame_id + "'");
  const bool same_time = source.stamp.isZero() || source.stamp == camera.stamp || recorded_.empty();
  if (source.frame_id == camera.frame_id && same_time)
    return Eigen::Isometry3d::Identity();
  try
  {
    // Between two times the camera moves and the session frame, which is fixed to the object's support, does not.
    return fromTransform(same_time
                             ? buffer_.lookupTransform(camera.frame_id, source.frame_id, camera.stamp, tf_timeout_)
                             : buffer_.lookupTransform(camera.frame_id, camera.stamp, source.frame_id, source.stamp,
                                                       frame_id_, tf_timeout_));
  }
  catch (const tf2::TransformException& error)
  {
    throw base::Error(
        base::StatusCode::FAILED_PRECONDITION,
        "tf cannot tell where frame '" + source.frame_id + "' is from '" + camera.frame_id + "': " + error.what());
  }
}

}  // namespace object_modelling::nodes
