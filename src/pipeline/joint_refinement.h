#pragma once

#include <string>
#include <vector>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::pipeline
{
/// Multi-view ICP on the object over the keyframes of all sessions, which T_session_camera places in one frame. One
/// session has been refined already and stays. Returns what went wrong; the poses then stay too.
std::string refineJointly(const std::vector<alignment::SessionPlacement>& placements,
                          const Eigen::Vector2d& color_offset_px, std::vector<rgbd::Keyframe>* keyframes,
                          base::JobControl& control);

}  // namespace object_modelling::pipeline
