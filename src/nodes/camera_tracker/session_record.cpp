#include "session_record.h"

#include <chrono>
#include <thread>

namespace object_modelling::nodes
{
namespace
{
constexpr std::chrono::milliseconds POLL_PERIOD(50);
}

SessionRecord::SessionRecord(keyframes::SessionStore& store, double stored_timeout_s)
    : store_(store), stored_timeout_s_(stored_timeout_s)
{
}

bool SessionRecord::has(const std::string& session_id)
{
  try
  {
    store_.session(session_id);
    return true;
  }
  catch (const base::Error& error)
  {
    if (error.code() == base::StatusCode::NOT_FOUND)
      return false;
    throw;
  }
}

void SessionRecord::requireFree(const std::string& session_id)
{
  if (has(session_id))
    throw base::Error(
        base::StatusCode::FAILED_PRECONDITION,
        "session '" + session_id + "' is in the store already; choose another id, or set resume to continue it");
}

std::string SessionRecord::freeId(const std::string& session_id)
{
  std::string id = session_id;
  for (int n = 2; has(id); ++n)
    id = session_id + "_" + std::to_string(n);
  return id;
}

std::vector<rgbd::Keyframe> SessionRecord::reopen(const std::string& session_id,
                                                  const rgbd::SensorNoiseModel& noise_model)
{
  const keyframes::Session session = store_.session(session_id);
  if (session.calibration.noise_model != noise_model)
    throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                      "session '" + session_id +
                          "' was recorded with another noise model, which its depth has been corrected by; start the "
                          "tracker with that one (noise_model), or record a new session");
  std::vector<rgbd::Keyframe> keyframes = keyframes::loadKeyframes(store_, session_id);
  if (keyframes.empty())
    throw base::Error(base::StatusCode::NO_RESULT,
                      "session '" + session_id + "' has no keyframes to continue from; delete it and start anew");
  // The keyframes to come are not refined and show no object yet.
  keyframes::SessionChange change;
  change.closed = false;
  change.refined = change.segmented = keyframes::StageMark();
  change.refinement_report = "";
  change.support_plane_session = std::optional<geometry::Plane>();
  store_.update(session_id, change);
  return keyframes;
}

void SessionRecord::finish(const std::string& session_id, int sent_keyframe_count)
{
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(stored_timeout_s_);
  keyframes::Session session = store_.session(session_id);
  while (session.keyframe_count < sent_keyframe_count && std::chrono::steady_clock::now() < deadline)
  {
    std::this_thread::sleep_for(POLL_PERIOD);
    session = store_.session(session_id);
  }
  keyframes::SessionChange change;
  change.closed = true;
  store_.update(session_id, change);
  if (session.keyframe_count < sent_keyframe_count)
    throw base::Error(base::StatusCode::STORAGE, "the keyframe store has " + std::to_string(session.keyframe_count) +
                                                     " of the " + std::to_string(sent_keyframe_count) +
                                                     " keyframes of session '" + session_id +
                                                     "'; its ~state and log say why");
}

}  // namespace object_modelling::nodes
