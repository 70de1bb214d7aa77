#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::pipeline
{
struct JointRefinement
{
  std::vector<std::string> session_ids;
  std::vector<int> sessions;  ///< one per keyframe: which of them it is of
};

/// Multi-view ICP on the object between the keyframes of several sessions, which T_session_camera places in one frame.
/// Each session moves as a whole: by itself it was refined on all that it saw, which holds it better than the object
/// does. Shapes alone count: the print has done its share in alignment, and under another light, from another side it
/// leads astray. Returns what went wrong, with the sessions that nothing links to the others; the poses of those stay.
std::string refineJointly(const JointRefinement& joint, std::vector<rgbd::Keyframe>* keyframes,
                          base::JobControl& control);

}  // namespace object_modelling::pipeline
