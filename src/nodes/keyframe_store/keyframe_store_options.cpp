#include "keyframe_store_options.h"

#include <cstdlib>

#include "object_modelling/base/options.h"

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

std::vector<std::string> KeyframeStoreOptions::violations() const
{
  base::OptionsCheck check("keyframe_store");
  check.inRange("preview_rate_hz", preview_rate_hz, 0.1, 30.0);
  check.require("session_frame_id", !session_frame_id.empty() && session_frame_id.front() != '/',
                "must be a frame id without leading slash");
  check.include(preview.violations());
  return check.violations();
}

std::string storeConnection(const std::string& store_path)
{
  const std::string home = environment("HOME");
  if (store_path.empty())
  {
    const std::string ros_home = environment("ROS_HOME");
    return (ros_home.empty() ? home + "/.ros" : ros_home) + "/object_modelling/keyframes.sqlite";
  }
  return store_path.compare(0, 2, "~/") == 0 ? home + store_path.substr(1) : store_path;
}

}  // namespace object_modelling::nodes
