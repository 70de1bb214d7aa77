#pragma once

#include <condition_variable>
#include <mutex>

#include <object_modelling/TrackingState.h>
#include <ros/node_handle.h>

namespace object_modelling::nodes
{
/// Waits for the tracker's answer to one frame. Needs its callbacks to be called on another thread.
class LosslessGate
{
public:
  LosslessGate(ros::NodeHandle& node, const std::string& state_topic);

  /// True when a state with this stamp has come; false after the timeout or when ROS shuts down.
  bool waitFor(const ros::Time& stamp, double timeout_s);
  std::string topic() const { return subscriber_.getTopic(); }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

private:
  void take(const object_modelling::TrackingState::ConstPtr& state);

  std::mutex mutex_;
  std::condition_variable changed_;
  ros::Time last_stamp_;
  ros::Subscriber subscriber_;
};

}  // namespace object_modelling::nodes
