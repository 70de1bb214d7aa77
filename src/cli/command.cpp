#include "command.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "object_modelling/keyframes/session.h"
#include "object_modelling/rgbd/noise_model_file.h"

namespace object_modelling::cli
{
void addTrackingOptions(CLI::App& command, RecordArguments* arguments)
{
  command
      .add_option_function<std::string>(
          "--reference", [arguments](const std::string& value) { arguments->object_reference = value == "object"; },
          "What the camera is tracked against: 'scene' (camera moves round the object; default) or 'object' "
          "(turntable, "
          "or the object is moved in front of the camera; masks of the recording are used if it has them)")
      ->check(CLI::IsMember({ "scene", "object" }));
  command
      .add_option("--seed", arguments->seed,
                  "Seed of all random choices: the same recording and seed give the same result")
      ->capture_default_str();
  command.add_option("--noise-model", arguments->noise_model,
                     "YAML of the sensor's noise, depth bias, distortion and colour offset, from calibrate_noise and "
                     "calibrate_camera; "
                     "without it a Kinect's");
}

void addRecordOptions(CLI::App& command, RecordArguments* arguments)
{
  addTrackingOptions(command, arguments);
  command
      .add_option_function<std::string>(
          "--refinement",
          [arguments](const std::string& value) { arguments->refinement = pipeline::refinementMethodFrom(value); },
          "How keyframe poses are refined: 'bundle_adjustment' (landmarks), 'multi_view_icp' (surfaces; needs no "
          "texture) "
          "or 'both', one after the other (default)")
      ->check(CLI::IsMember({ "bundle_adjustment", "multi_view_icp", "both" }));
}

pipeline::RecordOptions recordOptions(const RecordArguments& arguments)
{
  pipeline::RecordOptions options;
  options.tracker.reference = arguments.object_reference ? tracking::Reference::OBJECT : tracking::Reference::SCENE;
  options.tracker.seed = arguments.seed;
  if (!arguments.noise_model.empty())
    options.frame.noise_model = rgbd::loadNoiseModel(arguments.noise_model);
  return options;
}

pipeline::RefinementOptions refinementOptions(const RecordArguments& arguments)
{
  pipeline::RefinementOptions options;
  options.method = arguments.refinement;
  options.bundle_adjustment.seed = arguments.seed;
  return options;
}

void requireOutputFolder(const std::string& path)
{
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (!std::filesystem::is_directory(folder) || std::filesystem::is_directory(path))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "--output " + path + ": must be a file in a folder that exists");
}

std::string sessionIdFrom(const std::string& recording)
{
  std::string path = recording;
  while (path.size() > 1 && path.back() == '/')
    path.pop_back();
  std::string id = path.substr(path.find_last_of('/') + 1);
  std::replace_if(
      id.begin(), id.end(), [](unsigned char c) { return !std::isalnum(c) && c != '_' && c != '-' && c != '.'; }, '_');
  id.resize(std::min<std::size_t>(id.size(), 60));
  return keyframes::isValidId(id) ? id : "recording";
}

}  // namespace object_modelling::cli
