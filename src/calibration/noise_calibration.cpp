#include "object_modelling/calibration/noise_calibration.h"

#include <algorithm>
#include <sstream>

#include "bias_fit.h"
#include "distortion_fit.h"
#include "edge_fraying.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/options.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "sigma_fit.h"
#include "wall_view.h"

namespace object_modelling::calibration
{
namespace
{
base::Error badLine(const std::string& path, int line, const std::string& text)
{
  return { base::StatusCode::BAD_INPUT, path + ":" + std::to_string(line) + ": '" + text +
                                            "' is no stamp (s) and distance (m) such as \"1305031102.17 1.25\"" };
}

std::vector<WallView> readViews(source::FrameSource& source, const NoiseCalibrationOptions& options,
                                base::JobControl& control, NoiseCalibration* calibration, EdgeProfiles* profiles,
                                cv::Size* size)
{
  rgbd::FrameBuilderOptions frame_options = options.frame;
  frame_options.noise_model = rgbd::SensorNoiseModel();
  rgbd::FrameBuilder builder(frame_options);
  std::vector<WallView> views;
  while (const std::optional<rgbd::RawFrame> raw = source.next())
  {
    control.report("calibrate", calibration->frame_count, source.size().value_or(0));
    ++calibration->frame_count;
    const base::Result<rgbd::Frame> frame = builder.build(*raw);
    if (!frame.ok())
    {
      ++calibration->unused["unreadable, or without depth"];
      continue;
    }
    if (!views.empty() && frame.value.depth_m.size() != *size)
    {
      ++calibration->unused["of another size than the first"];
      continue;
    }
    base::Result<WallView> view = viewWall(frame.value, options.min_wall_ratio);
    if (!view.ok())
    {
      ++calibration->unused[view.status.message];
      continue;
    }
    *size = frame.value.depth_m.size();
    addEdges(frame.value, view.value, profiles);
    view.value.region.release();
    views.push_back(std::move(view.value));
  }
  control.report("calibrate", calibration->frame_count, calibration->frame_count);
  calibration->used_count = static_cast<int>(views.size());
  return views;
}

std::string reasons(const NoiseCalibration& calibration)
{
  std::ostringstream text;
  for (const auto& [reason, count] : calibration.unused)
    text << "; " << count << " with " << reason;
  return text.str();
}

}  // namespace

std::vector<std::string> NoiseCalibrationOptions::violations() const
{
  base::OptionsCheck check("noise_calibration");
  check.include(frame.violations());
  check.inRange("min_wall_ratio", min_wall_ratio, 0.05, 1.0);
  check.inRange("min_frames", min_frames, 1, 100000);
  check.inRange("min_blocks_per_bin", min_blocks_per_bin, 1, 100000);
  check.inRange("min_distance_span_m", min_distance_span_m, 0.1, 10.0);
  check.inRange("grazing_from_rad", grazing_from_rad, 0.8, 1.5);
  return check.violations();
}

NoiseCalibration calibrateNoise(source::FrameSource& source, const std::vector<MeasuredDistance>& distances,
                                const NoiseCalibrationOptions& options, base::JobControl& control)
{
  base::checked(options);
  NoiseCalibration calibration;
  EdgeProfiles profiles;
  cv::Size size;
  const std::vector<WallView> views = readViews(source, options, control, &calibration, &profiles, &size);
  std::vector<WallBlock> blocks;
  for (const WallView& view : views)
    blocks.insert(blocks.end(), view.blocks.begin(), view.blocks.end());
  calibration.bins = binned(blocks, options.min_blocks_per_bin);
  if (calibration.used_count < options.min_frames || calibration.bins.empty())
  {
    calibration.status = { base::StatusCode::NO_RESULT,
                           "'" + source.name() + "': " + std::to_string(calibration.used_count) + " of " +
                               std::to_string(calibration.frame_count) + " frames show a wall, " +
                               std::to_string(options.min_frames) + " are needed" + reasons(calibration) +
                               ". Record a flat wall or door that fills most of the view" };
    return calibration;
  }
  const auto by_z = [](const WallBlock& a, const WallBlock& b) { return a.z_m < b.z_m; };
  const auto by_theta = [](const WallBlock& a, const WallBlock& b) { return a.theta_rad < b.theta_rad; };
  calibration.min_z_m = std::min_element(blocks.begin(), blocks.end(), by_z)->z_m;
  calibration.max_z_m = std::max_element(blocks.begin(), blocks.end(), by_z)->z_m;
  calibration.min_theta_rad = std::min_element(blocks.begin(), blocks.end(), by_theta)->theta_rad;
  calibration.max_theta_rad = std::max_element(blocks.begin(), blocks.end(), by_theta)->theta_rad;

  control.report("fit", 0, 3);
  fitAxialSigma(options, &calibration);
  fitLateralSigma(profiles, options, &calibration);
  control.report("fit", 1, 3);
  fitDistortion(views, size.width, size.height, &calibration);
  control.report("fit", 2, 3);
  fitBias(views, distances, &calibration);
  control.report("fit", 3, 3);
  return calibration;
}

std::vector<MeasuredDistance> readMeasuredDistances(const std::string& path)
{
  std::istringstream lines(base::readTextFile(path));
  std::vector<MeasuredDistance> distances;
  int number = 0;
  for (std::string line; std::getline(lines, line);)
  {
    ++number;
    const std::string text = line.substr(0, line.find('#'));
    if (text.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    std::istringstream words(text);
    words.imbue(std::locale::classic());
    MeasuredDistance distance;
    std::string rest;
    if (!(words >> distance.stamp_s >> distance.distance_m) || words >> rest || !(distance.distance_m > 0))
      throw badLine(path, number, line);
    distances.push_back(distance);
  }
  if (distances.empty())
    throw base::Error(base::StatusCode::BAD_INPUT, path + " holds no distances");
  return distances;
}

}  // namespace object_modelling::calibration
