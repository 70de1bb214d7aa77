#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include "debug_image.h"
#include "recording.h"

namespace object_modelling::nodes
{
/// Publishes what became of frames: ~pose, tf, ~debug_image, and last the latched ~state; and ~keyframe, before them.
class TrackingPublisher
{
public:
  TrackingPublisher(ros::NodeHandle& private_node, const CameraTrackerNodeOptions& options);

  void publishKeyframe(const rgbd::Keyframe& keyframe, const std::string& session_id,
                       const std::string& camera_frame_id);
  void publish(const TrackedFrame& tracked);
  void publishState(const object_modelling::TrackingState& state) { state_.publish(state); }

  /// Whether somebody takes the keyframes.
  /// Waits for a listener by the wall clock: nodes that start together find each other in some tenths of a second.
  bool keyframesAreHeard() const;
  std::string keyframeTopic() const { return keyframe_.getTopic(); }

private:
  void publishPose(const tracking::TrackingResult& result, const std_msgs::Header& header);

  std::string session_frame_id_;
  TfDirection tf_direction_;
  DebugImage debug_;
  ros::Publisher state_, pose_, keyframe_, debug_image_;
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace object_modelling::nodes
