#pragma once

#include <vector>

#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::rgbd
{
View viewOf(const Keyframe& keyframe, const Eigen::Isometry3d& T_world_session, int session_index,
            const Eigen::Vector2d& color_offset_px);

/// Of one session, whose frame is the world.
std::vector<View> viewsOf(const std::vector<Keyframe>& keyframes,
                          const Eigen::Vector2d& color_offset_px = Eigen::Vector2d::Zero());

}  // namespace object_modelling::rgbd
