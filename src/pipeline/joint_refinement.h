#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::pipeline
{
/// Multi-view ICP on the object between the views of several sessions; `session_ids` are by session_index. Each session
/// moves as a whole: by itself it was refined on all that it saw, which constrains it better than the object does.
/// Shapes alone count: the texture has done its share in alignment, and under another light, from another side it leads
/// astray. Returns what went wrong, with the sessions that nothing links to the others; the poses of those stay.
std::string refineJointly(const std::vector<std::string>& session_ids, std::vector<rgbd::View>* views,
                          base::JobControl& control);

}  // namespace object_modelling::pipeline
