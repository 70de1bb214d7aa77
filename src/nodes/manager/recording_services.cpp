#include "recording_services.h"

#include <object_modelling/ResetTracking.h>
#include <object_modelling/StartTracking.h>
#include <object_modelling/StopTracking.h>

#include "object_modelling/ros_bridge/names.h"
#include "service_answer.h"
#include "session_choice.h"

namespace object_modelling::nodes
{
namespace
{
namespace names = ros_bridge::names;
using Lock = std::lock_guard<std::mutex>;

std::string ofTracker(const char* name)
{
  return std::string(names::CAMERA_TRACKER) + "/" + name;
}
}  // namespace

RecordingServices::RecordingServices(ros::NodeHandle& node, ros::NodeHandle& slow_node, const ManagerOptions& options,
                                     keyframes::SessionStore& store, ManagerBoard& board)
    : node_(node), limits_{ options.service_wait_s, options.call_timeout_s }, store_(store), board_(board)
{
  tracker_ = node.subscribe(ofTracker(names::STATE), 1, &RecordingServices::onTracker, this);
  servers_ = { serve<Start>(slow_node, "start_session", this, &RecordingServices::start),
               serve<Stop>(slow_node, "stop_session", this, &RecordingServices::stop),
               serve<Discard>(slow_node, "discard_session", this, &RecordingServices::discard) };
}

void RecordingServices::onTracker(const object_modelling::TrackingStateConstPtr& reported)
{
  const Lock lock(board_.mutex);
  const ModellingState::Change change =
      board_.state.trackerReported(reported->recording, reported->session_id, reported->keyframe_count);
  if (!change.status.ok())
    board_.failed(change.status);
  else if (change.changed)
    board_.publishState();
}

void RecordingServices::start(const Start::Request& request, Start::Response& response)
{
  const Lock one_at_a_time(board_.commands);
  {
    const Lock lock(board_.mutex);
    board_.state.checkCanStart();
  }
  if (!request.session_id.empty())
    checkId("session id", request.session_id);
  if (!request.object_id.empty())
    checkId("object id", request.object_id);
  object_modelling::StartTracking::Request tracking;
  tracking.session_id = request.session_id;
  tracking.object_id = request.object_id;
  tracking.resume = request.resume;
  response.session_id = call<object_modelling::StartTracking>(ofTracker(names::START), tracking).session_id;
  {
    const Lock lock(board_.mutex);
    board_.state.started(response.session_id);
    board_.succeeded();
  }
  ROS_INFO("recording session '%s'", response.session_id.c_str());
}

void RecordingServices::stop(const Stop::Request&, Stop::Response& response)
{
  const Lock one_at_a_time(board_.commands);
  {
    const Lock lock(board_.mutex);
    board_.state.checkCanStop();
    board_.state.ending();
  }
  object_modelling::StopTracking::Response stopped;
  try
  {
    stopped = call<object_modelling::StopTracking>(ofTracker(names::STOP));
  }
  catch (const base::Error& error)
  {
    // If the tracker records all the same, its next report says so.
    const Lock lock(board_.mutex);
    board_.state.trackerLost();
    board_.failed(error.status());
    throw;
  }
  {
    const Lock lock(board_.mutex);
    board_.state.stopped(stopped.keyframe_count);
    board_.succeeded();
  }
  ROS_INFO("session '%s' has %d keyframes", stopped.session_id.c_str(), stopped.keyframe_count);
  response.session_id = stopped.session_id;
  response.keyframe_count = stopped.keyframe_count;
  response.frame_count = stopped.frame_count;
  response.tracked_count = stopped.tracked_count;
}

void RecordingServices::discard(const Discard::Request& request, Discard::Response& response)
{
  const Lock one_at_a_time(board_.commands);
  std::string session_id;
  bool recording = false;
  {
    const Lock lock(board_.mutex);
    session_id = board_.state.sessionToDiscard(request.session_id);
    recording = board_.state.isRecording(session_id);
  }
  if (recording)
    endRecording(session_id);
  deleteSession(session_id, recording);
  const Lock lock(board_.mutex);
  board_.state.discarded(session_id);
  board_.succeeded();
  response.session_id = session_id;
}

void RecordingServices::endRecording(const std::string& session_id)
{
  {
    const Lock lock(board_.mutex);
    board_.state.ending();
  }
  try
  {
    call<object_modelling::ResetTracking>(ofTracker(names::RESET));
  }
  catch (const base::Error& error)
  {
    if (error.code() == base::StatusCode::CANCELLED)
      throw;  // this node is being shut down
    ROS_WARN("discarding '%s' all the same: %s", session_id.c_str(), error.what());
    // If the tracker records all the same, its next report says so.
    const Lock lock(board_.mutex);
    board_.state.trackerLost();
    board_.publishState();
    return;
  }
  const Lock lock(board_.mutex);
  board_.state.stopped();
  board_.publishState();
}

void RecordingServices::deleteSession(const std::string& session_id, bool may_be_missing)
{
  try
  {
    store_.deleteSession(session_id);
  }
  catch (const base::Error& error)
  {
    if (error.code() == base::StatusCode::NOT_FOUND && may_be_missing)
      return;
    const Lock lock(board_.mutex);
    board_.failed(error.status());
    throw;
  }
}

}  // namespace object_modelling::nodes
