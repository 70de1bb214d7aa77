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

KeyframeStoreOptions readKeyframeStoreOptions(ros_bridge::ParamReader& reader)
{
  KeyframeStoreOptions options;
  reader.read("store_path", options.store_path);
  reader.read("session_frame_id", options.session_frame_id);
  reader.read("preview_rate_hz", options.preview_rate_hz);
  reader.read("preview/voxel_size_m", options.preview.voxel_size_m);
  reader.read("preview/max_depth_m", options.preview.max_depth_m);
  reader.read("preview/max_points", options.preview.max_points);
  reader.read("preview/max_keyframes", options.preview.max_keyframes);
  reader.include(options.violations());
  return options;
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
