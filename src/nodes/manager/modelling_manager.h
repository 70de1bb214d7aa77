#pragma once

#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include "build_services.h"
#include "object_modelling/ros_bridge/remote_session_store.h"
#include "recording_services.h"

namespace object_modelling::nodes
{
/// The node that a user calls: start, stop, discard, build, list, cancel. It only calls the others. What it hears from
/// them, and ~cancel, is taken by the thread that spins the node, and never waits; the other services wait for nodes
/// that may be slow or down, on threads of their own.
class ModellingManager
{
public:
  ModellingManager(ros::NodeHandle& node, ros::NodeHandle& private_node, const ManagerOptions& options);
  ~ModellingManager();

private:
  ros::CallbackQueue slow_queue_;
  ros::NodeHandle slow_node_;  ///< private, with slow_queue_
  ManagerBoard board_;
  ros_bridge::RemoteSessionStore store_;
  RecordingServices recording_;
  BuildServices building_;
  ros::AsyncSpinner slow_spinner_;
};

}  // namespace object_modelling::nodes
