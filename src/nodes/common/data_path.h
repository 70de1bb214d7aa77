#pragma once

#include <string>

namespace object_modelling::nodes
{
/// A path from a parameter: "~/" stands for the home folder; empty for `name` in the folder object_modelling of
/// ROS_HOME (~/.ros). Anything else, an URL too, stays as it is.
std::string dataPath(const std::string& path, const std::string& name);

}  // namespace object_modelling::nodes
