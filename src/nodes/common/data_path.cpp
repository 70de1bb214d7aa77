#include "data_path.h"

#include <cstdlib>

namespace object_modelling::nodes
{
namespace
{
std::string environment(const char* name)
{
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}
}  // namespace

std::string dataPath(const std::string& path, const std::string& name)
{
  const std::string home = environment("HOME");
  if (path.empty())
  {
    const std::string ros_home = environment("ROS_HOME");
    return (ros_home.empty() ? home + "/.ros" : ros_home) + "/object_modelling/" + name;
  }
  return path.compare(0, 2, "~/") == 0 ? home + path.substr(1) : path;
}

}  // namespace object_modelling::nodes
