#include "tracking_publisher.h"

#include <chrono>
#include <thread>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <object_modelling/Keyframe.h>
#include <sensor_msgs/Image.h>

#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/names.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
namespace
{
namespace names = ros_bridge::names;

constexpr int OUTPUT_QUEUE_SIZE = 10;
constexpr std::chrono::seconds LISTENER_WAIT(2);
constexpr std::chrono::milliseconds LISTENER_POLL(20);
/// Keyframes must not be lost while the store is busy.
constexpr int KEYFRAME_QUEUE_SIZE = 200;
}  // namespace

TrackingPublisher::TrackingPublisher(ros::NodeHandle& private_node, const CameraTrackerNodeOptions& options)
    : session_frame_id_(options.session_frame_id),
      tf_direction_(options.tf_direction),
      state_(private_node.advertise<TrackingState>(names::STATE, OUTPUT_QUEUE_SIZE, true)),
      pose_(private_node.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", OUTPUT_QUEUE_SIZE)),
      keyframe_(private_node.advertise<object_modelling::Keyframe>(names::KEYFRAME, KEYFRAME_QUEUE_SIZE)),
      debug_image_(private_node.advertise<sensor_msgs::Image>("debug_image", 1))
{
}

bool TrackingPublisher::keyframesAreHeard() const
{
  const auto deadline = std::chrono::steady_clock::now() + LISTENER_WAIT;
  while (keyframe_.getNumSubscribers() == 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(LISTENER_POLL);
  return keyframe_.getNumSubscribers() > 0;
}

void TrackingPublisher::publishPose(const tracking::TrackingResult& result, const std_msgs::Header& header)
{
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header.stamp = header.stamp;
  pose.header.frame_id = session_frame_id_;
  pose.pose = ros_bridge::toMessage(result.T_session_camera, result.covariance);
  pose_.publish(pose);

  if (tf_direction_ == TfDirection::NONE)
    return;
  const bool session_below = tf_direction_ == TfDirection::SESSION_BELOW_CAMERA;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = header.stamp;
  transform.header.frame_id = session_below ? header.frame_id : session_frame_id_;
  transform.child_frame_id = session_below ? session_frame_id_ : header.frame_id;
  transform.transform =
      ros_bridge::toTransformMessage(session_below ? result.T_session_camera.inverse() : result.T_session_camera);
  broadcaster_.sendTransform(transform);
}

void TrackingPublisher::publishKeyframe(const rgbd::Keyframe& keyframe, const std::string& session_id,
                                        const std::string& camera_frame_id)
{
  keyframe_.publish(ros_bridge::toMessage(keyframe, session_id, camera_frame_id));
}

void TrackingPublisher::publish(const TrackedFrame& tracked)
{
  const std_msgs::Header& header = tracked.state.header;
  if (tracked.result && tracked.result->keyframe)
    debug_.setKeyframe(*tracked.result->keyframe);
  if (tracked.result && tracked.result->tracked())
    publishPose(*tracked.result, header);
  if (tracked.frame && debug_image_.getNumSubscribers() > 0)
    debug_image_.publish(ros_bridge::toMessage(debug_.draw(tracked), header));
  state_.publish(tracked.state);
}

}  // namespace object_modelling::nodes
