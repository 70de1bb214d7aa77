#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>

#include "command.h"
#include "object_modelling/calibration/noise_calibration.h"
#include "object_modelling/rgbd/noise_model_file.h"
#include "object_modelling/ros_bridge/recording.h"

namespace object_modelling::cli
{
namespace
{
struct CalibrateNoiseArguments
{
  std::string recording;
  std::string output = "noise.yaml";
  std::string distances;
};

nlohmann::json toJson(const calibration::NoiseCalibration& result)
{
  nlohmann::json coefficients = nlohmann::json::object(), bins = nlohmann::json::array();
  nlohmann::json lateral_bins = nlohmann::json::array();
  for (const calibration::LateralBin& bin : result.lateral_bins)
    lateral_bins.push_back({ { "theta_rad", bin.theta_rad },
                             { "edge_count", bin.edge_count },
                             { "length_px", bin.length_px },
                             { "sigma_px", bin.sigma_px } });
  for (const calibration::CoefficientReport& report : result.coefficients)
    coefficients[report.name] = { { "fitted", report.fitted }, { "reason", report.reason } };
  for (const calibration::NoiseBin& bin : result.bins)
    bins.push_back({ { "z_m", bin.z_m },
                     { "theta_rad", bin.theta_rad },
                     { "block_count", bin.block_count },
                     { "sigma_m", bin.sigma_m },
                     { "fitted_sigma_m", bin.fitted_sigma_m } });
  return { { "frame_count", result.frame_count },
           { "used_count", result.used_count },
           { "unused", result.unused },
           { "min_z_m", result.min_z_m },
           { "max_z_m", result.max_z_m },
           { "min_theta_rad", result.min_theta_rad },
           { "max_theta_rad", result.max_theta_rad },
           { "edge_count", result.edge_count },
           { "flatness_before_ratio", result.flatness_before_ratio },
           { "flatness_after_ratio", result.flatness_after_ratio },
           { "coefficients", coefficients },
           { "bins", bins },
           { "lateral_bins", lateral_bins } };
}

std::string toText(const calibration::NoiseCalibration& result)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2);
  text << "frames    " << result.used_count << " of " << result.frame_count << " show the wall, from " << result.min_z_m
       << " to " << result.max_z_m << " m, " << std::setprecision(0) << result.min_theta_rad * 180 / M_PI << " to "
       << result.max_theta_rad * 180 / M_PI << " deg\n";
  for (const auto& [reason, count] : result.unused)
    text << "          " << count << " not used: " << reason << "\n";
  for (const calibration::CoefficientReport& report : result.coefficients)
    text << (report.fitted ? "fitted    " : "default   ") << report.name << ": " << report.reason << "\n";
  text << std::setprecision(2);
  for (const double z_m : { 0.5, 1.0, 2.0 })
    text << "sigma     " << z_m << " m: " << 1000 * result.model.axialSigma_m(z_m, 0) << " mm axial, "
         << result.model.lateralSigma_px(0) << " px lateral\n";
  return text.str();
}

CommandOutput run(const CalibrateNoiseArguments& arguments, base::JobControl& control)
{
  requireOutputFolder(arguments.output);
  std::vector<calibration::MeasuredDistance> distances;
  if (!arguments.distances.empty())
    distances = calibration::readMeasuredDistances(arguments.distances);
  const std::unique_ptr<source::FrameSource> source = ros_bridge::openRecording(arguments.recording);
  const calibration::NoiseCalibration result = calibration::calibrateNoise(*source, distances, {}, control);
  if (!result.status.ok())
    throw base::Error(result.status.code, result.status.message);
  control.checkCancelled();
  CommandOutput output;
  output.text = toText(result);
  output.json = toJson(result);
  rgbd::saveNoiseModel(arguments.output, result.model,
                       "Measured on " + source->name() + "; docs/noise_model.md\n" + output.text);
  output.text += "written   " + arguments.output + "\n";
  output.json["output"] = arguments.output;
  return output;
}
}  // namespace

void addCalibrateNoiseCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<CalibrateNoiseArguments>();
  CLI::App* command =
      app.add_subcommand("calibrate_noise", "Noise and depth bias of a sensor from a recording of a flat wall or door");
  command
      ->add_option("recording", arguments->recording,
                   "TUM-style folder or ROS bag: a wall that fills most of the view, from several distances and angles")
      ->required();
  command->add_option("--output", arguments->output, "YAML for --noise-model and the nodes' parameter noise_model")
      ->capture_default_str();
  command->add_option("--distances", arguments->distances,
                      "File of lines 'stamp_s distance_m': measured shortest distances from camera to wall, for the "
                      "depth bias");
  command->footer("Example: object_modelling calibrate_noise door.bag --output xtion.yaml");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
