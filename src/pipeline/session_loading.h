#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::pipeline
{
/// All keyframes of a session, with progress in the stage "load".
std::vector<rgbd::Keyframe> loadReported(keyframes::SessionStore& store, const std::string& session_id,
                                         base::JobControl& control);

base::Status noKeyframes(const std::string& session_id);

}  // namespace object_modelling::pipeline
