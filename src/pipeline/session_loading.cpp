#include "session_loading.h"

namespace object_modelling::pipeline
{
std::vector<rgbd::Keyframe> loadReported(keyframes::SessionStore& store, const std::string& session_id,
                                         base::JobControl& control)
{
  const std::vector<int> ids = store.keyframeIds(session_id);
  std::vector<rgbd::Keyframe> keyframes;
  keyframes.reserve(ids.size());
  for (const int id : ids)
  {
    control.report("load", keyframes.size(), ids.size());
    keyframes.push_back(store.keyframe(session_id, id));
  }
  control.report("load", ids.size(), ids.size());
  return keyframes;
}

base::Status noKeyframes(const std::string& session_id)
{
  return { base::StatusCode::FAILED_PRECONDITION,
           "session '" + session_id + "' has no keyframes: record it with the camera tracking the scene first" };
}

}  // namespace object_modelling::pipeline
