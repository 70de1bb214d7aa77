#include "object_modelling/pipeline/session_sink.h"

#include <glog/logging.h>

namespace object_modelling::pipeline
{
void StoreSink::create(const keyframes::Session& session)
{
  store_.createSession(session);
}

std::vector<rgbd::Keyframe> StoreSink::stored(const std::string& session_id, const rgbd::SensorNoiseModel& noise_model)
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
  return keyframes;
}

void StoreSink::reopen(const std::string& session_id)
{
  // The keyframes to come are not refined and show no object yet.
  keyframes::SessionChange change;
  change.closed = false;
  change.refined = change.segmented = keyframes::StageMark();
  change.refinement_report = "";
  change.support_plane_session = std::optional<geometry::Plane>();
  store_.update(session_id, change);
}

void StoreSink::add(const std::string& session_id, const rgbd::Keyframe& keyframe, const std::string&)
{
  store_.addKeyframe(session_id, keyframe);
}

void StoreSink::close(const std::string& session_id, int)
{
  keyframes::SessionChange change;
  change.closed = true;
  store_.update(session_id, change);
}

void StoreSink::discard(const std::string& session_id) noexcept
{
  try
  {
    store_.deleteSession(session_id);
  }
  catch (const std::exception& error)
  {
    LOG(ERROR) << "session '" << session_id << "' of a failed recording stays in the store: " << error.what();
  }
}

}  // namespace object_modelling::pipeline
