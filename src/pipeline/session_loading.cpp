#include "session_loading.h"

namespace object_modelling::pipeline
{
std::vector<rgbd::Keyframe> loadReported(keyframes::SessionStore& store, const std::string& session_id,
                                         base::JobControl& control)
{
  return keyframes::loadKeyframes(store, session_id,
                                  [&](std::size_t done, std::size_t total) { control.report("load", done, total); });
}

base::Status noKeyframes(const std::string& session_id)
{
  return { base::StatusCode::FAILED_PRECONDITION,
           "session '" + session_id + "' has no keyframes: record it with the camera tracking the scene first" };
}

}  // namespace object_modelling::pipeline
