// Segments recordings with true masks and poses, and prints how well masks and support planes agree with the truth.
// benchmark_masks --help; docs/measurements.md, Segmentation.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "benchmark_program.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/segmentation/object_mask_propagator.h"
#include "object_modelling/source/trajectory_file.h"
#include "object_modelling/source/tum_folder.h"

namespace
{
using namespace object_modelling;

/// Frames of a recording that have a true mask, at their true poses. The session frame is the kit's world: the table is
/// the plane z = 0.
struct Truth
{
  std::vector<rgbd::Keyframe> keyframes;  ///< without masks
  std::vector<cv::Mat> instances;         ///< CV_8UC1: instance per pixel
};

struct Object
{
  std::string name;
  int instance = 0;
};

struct Agreement
{
  std::string recording, object, problem;
  std::vector<double> ious;              ///< by keyframe that shows the object, in [0, 1]; 0 where no mask was found
  std::optional<double> plane_mm;        ///< height error of the support plane under the object
  std::optional<double> plane_tilt_deg;  ///< angle between the plane's normal and the true one
};

std::string key(double stamp_s)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(6) << stamp_s;
  return out.str();
}

/// Path of the mask image by stamp, from mask.txt.
std::map<std::string, std::string> maskPaths(const std::string& recording)
{
  std::ifstream list(recording + "/mask.txt");
  if (!list)
    throw base::Error(base::StatusCode::NOT_FOUND, "'" + recording + "' has no mask.txt: make it with mask_every");
  std::map<std::string, std::string> paths;
  for (std::string line; std::getline(list, line);)
  {
    std::istringstream fields(line);
    double stamp_s = 0;
    std::string path;
    if (line.rfind('#', 0) != 0 && fields >> stamp_s >> path)
      paths[key(stamp_s)] = (std::filesystem::path(recording) / path).string();
  }
  return paths;
}

std::vector<Object> objectsOf(const std::string& recording)
{
  std::vector<Object> objects;
  for (const YAML::Node& node : YAML::LoadFile(recording + "/objects.yaml")["objects"])
    objects.push_back({ node["name"].as<std::string>(), node["instance"].as<int>() });
  return objects;
}

Truth truthOf(const std::string& recording)
{
  const std::map<std::string, std::string> paths = maskPaths(recording);
  std::map<std::string, Eigen::Isometry3d> poses;
  for (const source::StampedPose& pose : source::readTrajectory(recording + "/groundtruth.txt"))
    poses[key(pose.stamp_s)] = pose.T_map_camera;
  source::TumFolderOptions options;
  options.use_masks = false;
  const std::unique_ptr<source::FrameSource> source = source::openTumFolder(recording, options);
  rgbd::FrameBuilder builder;
  Truth truth;
  while (const std::optional<rgbd::RawFrame> raw = source->next())
  {
    const auto path = paths.find(key(raw->stamp_s));
    const auto pose = poses.find(key(raw->stamp_s));
    if (path == paths.end() || pose == poses.end())
      continue;
    const base::Result<rgbd::Frame> frame = builder.build(*raw);
    const cv::Mat instances = cv::imread(path->second, cv::IMREAD_GRAYSCALE);
    if (!frame.ok() || instances.size() != frame.value.depth_m.size())
      throw base::Error(base::StatusCode::BAD_INPUT, "'" + path->second + "' or its frame cannot be used");
    rgbd::Keyframe keyframe;
    keyframe.id = static_cast<int>(truth.keyframes.size());
    keyframe.frame = frame.value;
    keyframe.T_session_camera = pose->second;
    truth.keyframes.push_back(keyframe);
    truth.instances.push_back(instances);
  }
  return truth;
}

/// True mask of an object where depth is measured, CV_8UC1.
cv::Mat trueMask(const Truth& truth, std::size_t k, int instance)
{
  const cv::Mat& depth_m = truth.keyframes[k].frame.depth_m;
  return (truth.instances[k] == instance) & (depth_m == depth_m);  // NaN differs from itself
}

/// Median of the object's points, in the session frame, in the view that shows most of it.
Eigen::Vector3d middleOf(const Truth& truth, int instance)
{
  int most = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < truth.keyframes.size(); ++k)
  {
    const cv::Mat mask = trueMask(truth, k, instance);
    if (cv::countNonZero(mask) <= most)
      continue;
    most = cv::countNonZero(mask);
    std::vector<cv::Point> pixels;
    cv::findNonZero(mask, pixels);
    std::array<std::vector<double>, 3> coordinates;
    for (const cv::Point& pixel : pixels)
    {
      const Eigen::Vector3d p =
          truth.keyframes[k].T_session_camera * truth.keyframes[k].frame.point(pixel.x, pixel.y).cast<double>();
      for (int axis = 0; axis < 3; ++axis)
        coordinates[axis].push_back(p[axis]);
    }
    for (int axis = 0; axis < 3; ++axis)
      middle[axis] = base::median(&coordinates[axis]);
  }
  return middle;
}

Agreement compare(const std::string& recording, const Truth& truth, const Object& object, bool by_seed)
{
  Agreement agreement;
  agreement.recording = recording;
  agreement.object = object.name;
  const Eigen::Vector3d middle = middleOf(truth, object.instance);
  const segmentation::SessionMasks found =
      segmentation::segmentSession(truth.keyframes, by_seed ? std::optional<Eigen::Vector3d>(middle) : std::nullopt);
  if (!found.status.ok())
  {
    agreement.problem = found.status.message;
    return agreement;
  }
  for (std::size_t k = 0; k < truth.keyframes.size(); ++k)
  {
    const cv::Mat mask = trueMask(truth, k, object.instance);
    if (cv::countNonZero(mask) == 0)
      continue;
    const cv::Mat& other = found.masks[k];
    agreement.ious.push_back(
        other.empty() ? 0.0 : static_cast<double>(cv::countNonZero(mask & other)) / cv::countNonZero(mask | other));
  }
  if (found.support_plane_session)
  {
    const geometry::Plane& plane = *found.support_plane_session;
    agreement.plane_mm = 1e3 * std::abs(plane.signedDistance_m({ middle.x(), middle.y(), 0 }));
    agreement.plane_tilt_deg = std::acos(std::min(1.0, plane.normal.z())) * 180 / M_PI;
  }
  return agreement;
}

double mean(const std::vector<double>& values)
{
  double sum = 0;
  for (const double value : values)
    sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double smallest(const std::vector<double>& values)
{
  return values.empty() ? 0 : *std::min_element(values.begin(), values.end());
}

std::string toRow(const Agreement& agreement)
{
  std::ostringstream out;
  out << std::fixed << "| " << agreement.recording << " | " << agreement.object << " | " << agreement.ious.size()
      << " | ";
  if (!agreement.problem.empty())
    return out.str() + agreement.problem + " | | |\n";
  out << std::setprecision(3) << mean(agreement.ious) << " | " << smallest(agreement.ious) << " | ";
  if (agreement.plane_mm)
    out << std::setprecision(2) << *agreement.plane_mm << " mm, " << std::setprecision(3) << *agreement.plane_tilt_deg
        << " deg";
  out << " |\n";
  return out.str();
}

nlohmann::json toJson(const Agreement& agreement)
{
  nlohmann::json json = { { "recording", agreement.recording },    { "object", agreement.object },
                          { "keyframes", agreement.ious.size() },  { "iou_mean", mean(agreement.ious) },
                          { "iou_min", smallest(agreement.ious) }, { "ious", agreement.ious },
                          { "problem", agreement.problem } };
  json["support_plane_mm"] = agreement.plane_mm ? nlohmann::json(*agreement.plane_mm) : nlohmann::json();
  json["support_plane_tilt_deg"] =
      agreement.plane_tilt_deg ? nlohmann::json(*agreement.plane_tilt_deg) : nlohmann::json();
  return json;
}

/// The last two path components, since "session_1" is not unique.
std::string nameOf(const std::string& recording)
{
  const std::filesystem::path path = std::filesystem::absolute(recording + "/").parent_path().lexically_normal();
  return path.parent_path().filename().string() + "/" + path.filename().string();
}

void run(const std::vector<std::string>& recordings, const std::string& json_path)
{
  nlohmann::json json = nlohmann::json::array();
  std::cout << "| recording | object | keyframes | IoU mean | min | support plane |\n|---|---|---|---|---|---|\n";
  for (const std::string& recording : recordings)
  {
    const Truth truth = truthOf(recording);
    const std::vector<Object> objects = objectsOf(recording);
    for (const Object& object : objects)
    {
      const Agreement agreement = compare(nameOf(recording), truth, object, objects.size() > 1);
      std::cout << toRow(agreement) << std::flush;
      json.push_back(toJson(agreement));
    }
  }
  benchmark_program::writeJson(json_path, json);
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Masks and support planes of simulated recordings against the truth.");
  app.footer(
      "Recordings are those of evaluation_kit/simulate.py with output: {mask_every: N}; every frame with a mask is a\n"
      "keyframe, at its true pose. IoU counts pixels with depth. Of several objects each is named by a point on it; a\n"
      "single one is chosen automatically. Exit codes: 1 failed, 2 wrong usage.");
  std::vector<std::string> recordings;
  std::string json;
  app.add_option("recordings", recordings, "Folders of the evaluation kit")->required()->check(CLI::ExistingDirectory);
  app.add_option("--json", json, "Also write all figures to this file");
  return object_modelling::benchmark_program::run(app, argc, argv, [&] { run(recordings, json); });
}
