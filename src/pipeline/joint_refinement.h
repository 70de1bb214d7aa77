#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::pipeline
{
struct JointRefinement
{
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
  std::vector<int> sessions;  ///< one per keyframe, tells them apart
  bool print_holds = false;   ///< grey levels of different sessions show the same
};

/// Whether the colours of each of these sessions agree with those of another where they were aligned. Of an object
/// without print they are light alone, which would lead astray.
bool printHolds(keyframes::SessionStore& store, const std::vector<std::string>& session_ids);

/// Multi-view ICP on the object between the keyframes of several sessions, which T_session_camera places in one frame.
/// Each session moves as a whole: by itself it was refined on all that it saw, which holds it better than the object
/// does. Returns what went wrong; the poses then stay.
std::string refineJointly(const JointRefinement& joint, std::vector<rgbd::Keyframe>* keyframes,
                          base::JobControl& control);

}  // namespace object_modelling::pipeline
