#pragma once

#include <optional>
#include <string>

#include "object_modelling/base/status.h"

namespace object_modelling::nodes
{
/// The numbers are those of msg/ManagerState.msg.
enum class ManagerPhase : unsigned char
{
  IDLE = 0,
  RECORDING = 1,
  BUILDING = 2
};

/// State machine of the modelling manager; free of ROS and of time. Recording follows the camera tracker: what it
/// reports is true, whoever started it. Every wrong order is refused with the state and the way out
/// (FAILED_PRECONDITION); no order of calls and reports needs a restart. Not thread safe: the caller holds a lock.
class ModellingState
{
public:
  ManagerPhase phase() const { return phase_; }
  /// The session being recorded, or the last one; empty before the first.
  const std::string& sessionId() const { return session_id_; }
  /// The object being built, or the last one; empty before the first.
  const std::string& objectId() const { return object_id_; }
  int keyframeCount() const { return keyframe_count_; }
  const std::string& stage() const { return stage_; }

  void checkCanStart() const;
  void started(const std::string& session_id);
  void checkCanStop() const;
  /// The recording is about to be ended on a call: the tracker's report of it is no surprise.
  void ending() { ending_ = true; }
  /// `keyframe_count`: none if it is not known.
  void stopped(std::optional<int> keyframe_count = std::nullopt);
  /// Nothing is recorded any more, unless the tracker comes back and reports otherwise. What it stored stays.
  void trackerLost();
  /// Id of the session to delete: the one asked for, or the current or last one.
  std::string sessionToDiscard(const std::string& requested) const;
  void discarded(const std::string& session_id);
  bool isRecording(const std::string& session_id) const;

  struct Change
  {
    bool changed = false;
    base::Status status;  ///< not OK: a recording ended without a call to the manager
  };
  /// Takes over the tracker's reported state.
  Change trackerReported(bool recording, const std::string& session_id, int keyframe_count);

  void beginBuild(const std::string& object_id);
  /// True if it is another one than before.
  bool enterStage(const std::string& stage);
  void endBuild();
  void checkCanCancel() const;

private:
  void checkNotBuilding(const std::string& wish) const;

  ManagerPhase phase_ = ManagerPhase::IDLE;
  std::string session_id_, object_id_, stage_;
  int keyframe_count_ = 0;
  // Reports of the tracker may be older than our last call: "not recording" counts only once it has reported the
  // session that was started, "recording" not for the session that was just stopped.
  bool confirmed_ = false;
  std::optional<std::string> stopped_session_id_;
  bool ending_ = false;  ///< on a call of ours that has not returned yet
};

}  // namespace object_modelling::nodes
