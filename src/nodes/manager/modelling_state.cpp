#include "modelling_state.h"

namespace object_modelling::nodes
{
namespace
{
base::Error refusal(const std::string& message)
{
  return base::Error(base::StatusCode::FAILED_PRECONDITION, message);
}
}  // namespace

void ModellingState::checkCanStart() const
{
  if (phase_ == ManagerPhase::RECORDING)
    throw refusal("session '" + session_id_ + "' is being recorded: stop_session or discard_session first");
  checkNotBuilding("start a session");
}

void ModellingState::started(const std::string& session_id)
{
  if (isRecording(session_id))
    return;  // the tracker's report was faster than its answer
  phase_ = ManagerPhase::RECORDING;
  session_id_ = session_id;
  keyframe_count_ = 0;
  confirmed_ = false;
  stopped_session_id_.reset();
}

void ModellingState::checkCanStop() const
{
  if (phase_ == ManagerPhase::RECORDING)
    return;
  const std::string last =
      session_id_.empty() ? "none has been recorded yet" : "the last one was '" + session_id_ + "'";
  throw refusal("no session is being recorded (" + last + "): start_session first");
}

void ModellingState::stopped(std::optional<int> keyframe_count)
{
  ending_ = false;
  if (phase_ == ManagerPhase::RECORDING)
  {
    phase_ = ManagerPhase::IDLE;
    stopped_session_id_ = session_id_;
  }
  if (keyframe_count)
    keyframe_count_ = *keyframe_count;
}

void ModellingState::trackerLost()
{
  stopped();
  stopped_session_id_.reset();
  confirmed_ = false;
}

std::string ModellingState::sessionToDiscard(const std::string& requested) const
{
  checkNotBuilding("discard a session");
  const std::string& session_id = requested.empty() ? session_id_ : requested;
  if (session_id.empty())
    throw refusal("no session has been recorded since the manager started: name the session to discard");
  return session_id;
}

void ModellingState::discarded(const std::string& session_id)
{
  ending_ = false;
  if (session_id != session_id_)
    return;
  stopped(0);
  session_id_.clear();
}

bool ModellingState::isRecording(const std::string& session_id) const
{
  return phase_ == ManagerPhase::RECORDING && session_id_ == session_id;
}

ModellingState::Change ModellingState::trackerReported(bool recording, const std::string& session_id,
                                                       int keyframe_count)
{
  if (recording)
  {
    if (stopped_session_id_ == session_id)
      return {};
    const bool changed =
        phase_ != ManagerPhase::RECORDING || session_id_ != session_id || keyframe_count_ != keyframe_count;
    if (phase_ != ManagerPhase::BUILDING)
      phase_ = ManagerPhase::RECORDING;
    session_id_ = session_id;
    keyframe_count_ = keyframe_count;
    confirmed_ = true;
    return { changed, {} };
  }
  stopped_session_id_.reset();
  if (phase_ != ManagerPhase::RECORDING || ending_ || !confirmed_)
    return {};
  stopped();
  return { true,
           refusal("the camera tracker no longer records session '" + session_id_ +
                   "': it was stopped or restarted by somebody else; the keyframes so far are stored: start_session "
                   "with resume to go on, or build_object")
               .status() };
}

void ModellingState::beginBuild(const std::string& object_id)
{
  if (phase_ == ManagerPhase::RECORDING)
    throw refusal("session '" + session_id_ + "' is being recorded: stop_session before building '" + object_id + "'");
  checkNotBuilding("build '" + object_id + "'");
  phase_ = ManagerPhase::BUILDING;
  object_id_ = object_id;
  stage_.clear();
}

bool ModellingState::enterStage(const std::string& stage)
{
  const bool changed = stage_ != stage;
  stage_ = stage;
  return changed;
}

void ModellingState::endBuild()
{
  phase_ = ManagerPhase::IDLE;
  stage_.clear();
}

void ModellingState::checkCanCancel() const
{
  if (phase_ != ManagerPhase::BUILDING)
    throw refusal("nothing to cancel: no object is being built (to drop a recording: discard_session)");
}

void ModellingState::checkNotBuilding(const std::string& wish) const
{
  if (phase_ == ManagerPhase::BUILDING)
    throw refusal("cannot " + wish + " while object '" + object_id_ + "' is being built (stage '" +
                  (stage_.empty() ? "beginning" : stage_) + "'): wait for it, or cancel");
}

}  // namespace object_modelling::nodes
