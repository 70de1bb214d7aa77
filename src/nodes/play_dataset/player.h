#pragma once

#include <memory>

#include <ros/node_handle.h>

#include "lossless_gate.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/ros_bridge/frame_publisher.h"
#include "play_options.h"

namespace object_modelling::nodes
{
/// Plays a recording on topics. Throws base::Error for a recording that cannot be read and a tracker that does not
/// answer.
class Player
{
public:
  Player(ros::NodeHandle& node, const PlayOptions& options);

  /// Plays to the end, or until ROS shuts down. Returns a one-line summary.
  std::string play();

private:
  void waitForListeners();
  void playOnce();
  void send(const rgbd::RawFrame& raw);
  void waitUntilDue(double stamp_s);

  PlayOptions options_;
  std::unique_ptr<source::FrameSource> source_;
  rgbd::FrameBuilder builder_;
  ros_bridge::FramePublisher publisher_;
  std::unique_ptr<LosslessGate> gate_;
  double stamp_shift_s_ = 0;  ///< of the present round of a loop
  double first_stamp_s_ = -1, last_stamp_s_ = -1, frame_period_s_ = 0;
  ros::WallTime began_;
  std::size_t played_count_ = 0, refused_count_ = 0;
};

}  // namespace object_modelling::nodes
