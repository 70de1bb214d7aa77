#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::pipeline
{
/// Multi-view ICP on the object over the keyframes of all sessions, which T_session_camera places in one frame. Returns
/// what went wrong; the poses then stay.
std::string refineJointly(const Eigen::Vector2d& color_offset_px, std::vector<rgbd::Keyframe>* keyframes,
                          base::JobControl& control);

}  // namespace object_modelling::pipeline
