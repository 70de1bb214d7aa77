#pragma once

#include <string>
#include <vector>

#include <object_modelling/DiscardSession.h>
#include <object_modelling/StartSession.h>
#include <object_modelling/StopSession.h>
#include <object_modelling/TrackingState.h>

#include "manager_board.h"
#include "manager_options.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/ros_bridge/timed_call.h"

namespace object_modelling::nodes
{
/// ~start_session, ~stop_session and ~discard_session: recording by the camera tracker, and its reported state.
class RecordingServices
{
public:
  /// The services' callbacks block, and belong to the queue of `slow_node`. `board` and `store` must outlive this.
  RecordingServices(ros::NodeHandle& node, ros::NodeHandle& slow_node, const ManagerOptions& options,
                    keyframes::SessionStore& store, ManagerBoard& board);

private:
  using Start = object_modelling::StartSession;
  using Stop = object_modelling::StopSession;
  using Discard = object_modelling::DiscardSession;

  void start(const Start::Request& request, Start::Response& response);
  void stop(const Stop::Request& request, Stop::Response& response);
  void discard(const Discard::Request& request, Discard::Response& response);
  void endRecording(const std::string& session_id);
  /// A session that was begun is in the store from its first keyframe on.
  void deleteSession(const std::string& session_id, bool may_be_missing);
  void onTracker(const object_modelling::TrackingStateConstPtr& reported);

  template <typename Service>
  typename Service::Response call(const std::string& name, const typename Service::Request& request = {})
  {
    Service service;
    service.request = request;
    ros_bridge::callInTime(node_, name, limits_, service);
    return service.response;
  }

  ros::NodeHandle node_;
  ros_bridge::CallLimits limits_;
  keyframes::SessionStore& store_;
  ManagerBoard& board_;
  ros::Subscriber tracker_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace object_modelling::nodes
