#include "robot_motion.h"

#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
const ros::WallDuration HISTORY_POLL_PERIOD(0.001);

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

RobotMotion::RobotMotion(const CameraTrackerNodeOptions& options)
    : options_(options.robot), session_frame_id_(options.session_frame_id)
{
  buffer_.setUsingDedicatedThread(true);
  if (!options_.frame_id.empty())
    listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
}

bool RobotMotion::hangsBelowSession() const
{
  std::string frame = options_.frame_id, parent;
  while (frame != session_frame_id_ && buffer_._getParent(frame, ros::Time(), parent))
    frame = parent;
  return frame == session_frame_id_;
}

RobotPose RobotMotion::at(const std_msgs::Header& camera) const
{
  if (options_.frame_id.empty())
    return {};
  const std::string prefix = "the robot's motion is left out: ";
  if (options_.frame_id == camera.frame_id)
    return { {}, prefix + "robot/frame_id is the camera's own frame '" + camera.frame_id + "'", "" };
  if (hangsBelowSession())
    return { {},
             prefix + "'" + options_.frame_id + "' hangs below '" + session_frame_id_ +
                 "', which is this node's own result; robot/frame_id must be a frame of the robot",
             "" };
  // tf's own waiting goes by ROS time, which may stand still.
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(options_.wait_s);
  std::string reason;
  while (!buffer_.canTransform(options_.frame_id, camera.frame_id, camera.stamp, &reason))
  {
    if (ros::WallTime::now() >= deadline)
      return { {},
               prefix + "tf does not tell where '" + camera.frame_id + "' is in '" + options_.frame_id + "'",
               reason };
    reason.clear();
    HISTORY_POLL_PERIOD.sleep();
  }
  RobotPose pose;
  const base::Status status = ros_bridge::guarded(
      [&] {
        pose.T_robot_camera = fromTransform(buffer_.lookupTransform(options_.frame_id, camera.frame_id, camera.stamp));
      });
  if (!status.ok())
    pose.problem = prefix + status.message;
  return pose;
}

}  // namespace object_modelling::nodes
