#include "object_modelling/ros_bridge/recording.h"

#include <filesystem>

#include "object_modelling/source/bop_scene.h"

namespace object_modelling::ros_bridge
{
namespace
{
namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& reason)
{
  throw base::Error(base::StatusCode::BAD_INPUT, path + ": " + reason +
                                                     "; a recording is a TUM-style folder (rgb.txt, depth.txt, "
                                                     "camera.yaml), a scene of BOP (scene_camera.json) or a ROS bag "
                                                     "(.bag)");
}
}  // namespace

std::unique_ptr<source::FrameSource> openRecording(const std::string& path, const RecordingOptions& options)
{
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw base::Error(base::StatusCode::NOT_FOUND, path + ": there is no such recording");
  if (fs::is_directory(path, ignored) && source::isBopScene(path))
    return source::openBopScene(path);
  if (fs::is_directory(path, ignored))
    return source::openTumFolder(path, options.folder);
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".bag" || extension == ".active")
    return openBag(path, options.bag);
  if (extension == ".oni")
    refuse(path, ".oni is not supported yet");
  refuse(path, "not a kind of file that can be read");
}

}  // namespace object_modelling::ros_bridge
