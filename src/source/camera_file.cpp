#include "camera_file.h"

#include <cmath>

#include <yaml-cpp/yaml.h>

#include "object_modelling/base/atomic_file.h"
#include "text_table.h"

namespace object_modelling::source
{
namespace
{
constexpr char DEFAULT_FRAME_ID[] = "camera_rgb_optical_frame";

template <typename T>
T required(const YAML::Node& root, const std::string& key, const std::string& path)
{
  if (!root[key])
    throw badInput(path, "has no " + key);
  try
  {
    return root[key].as<T>();
  }
  catch (const YAML::Exception&)
  {
    throw badInput(path, key +
                             " is not what it should be (width and height: integers; fx, fy, cx, cy, depth_scale: "
                             "numbers; distortion: a list of numbers; frame_id: text)");
  }
}

YAML::Node load(const std::string& path)
{
  const std::string text = base::readTextFile(path);
  try
  {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsMap())
      throw badInput(path, "is not a list of \"key: value\" lines");
    return root;
  }
  catch (const YAML::Exception& error)
  {
    throw badInput(path, error.what());
  }
}

}  // namespace

CameraFile readCameraFile(const std::string& path)
{
  const YAML::Node root = load(path);
  CameraFile file;
  file.camera.width = required<int>(root, "width", path);
  file.camera.height = required<int>(root, "height", path);
  file.camera.fx = required<double>(root, "fx", path);
  file.camera.fy = required<double>(root, "fy", path);
  file.camera.cx = required<double>(root, "cx", path);
  file.camera.cy = required<double>(root, "cy", path);
  if (root["distortion"])
    file.camera.distortion = required<std::vector<double>>(root, "distortion", path);
  file.depth_unit_m = required<double>(root, "depth_scale", path);
  file.frame_id = root["frame_id"] ? required<std::string>(root, "frame_id", path) : DEFAULT_FRAME_ID;

  const std::vector<std::string> violations = file.camera.violations();
  if (!violations.empty())
    throw badInput(path, violations.front());
  if (!(file.depth_unit_m > 0 && std::isfinite(file.depth_unit_m)))
    throw badInput(path, "depth_scale = " + std::to_string(file.depth_unit_m) +
                             ": must be the positive number of metres per unit of the depth images");
  return file;
}

}  // namespace object_modelling::source
