#include <iomanip>
#include <memory>
#include <sstream>

#include <Eigen/Geometry>

#include "command.h"
#include "object_modelling/base/options.h"
#include "object_modelling/calibration/distortion_mean.h"
#include "object_modelling/rgbd/noise_model_file.h"
#include "object_modelling/ros_bridge/recording.h"
#include "temporary_store.h"

namespace object_modelling::cli
{
namespace
{
constexpr double MAX_SPREAD_PX = 0.15;  // half of what a flat scene errs by

struct CalibrateCameraArguments
{
  std::vector<std::string> recordings;
  std::string output = "noise.yaml";
  RecordArguments record;
};

/// A recording tracked with the model given, and adjusted with either offset or distortion as further unknowns:
/// together they take each other's part.
enum class Unknown
{
  COLOR_OFFSET,
  DEPTH_DISTORTION
};

bundle_adjustment::BundleAdjustmentResult adjusted(const std::string& recording, const rgbd::SensorNoiseModel& model,
                                                   Unknown unknown, const CalibrateCameraArguments& arguments,
                                                   base::JobControl& control)
{
  const std::unique_ptr<source::FrameSource> source = ros_bridge::openRecording(recording);
  TemporaryStore store;
  keyframes::Session session;
  session.id = sessionIdFrom(recording);
  pipeline::RecordOptions record = recordOptions(arguments.record);
  record.frame.noise_model = model;
  pipeline::recordSession(*source, session, &store.get(), record, control);
  pipeline::RefinementOptions options = refinementOptions(arguments.record);
  options.method = pipeline::RefinementMethod::BUNDLE_ADJUSTMENT;
  options.bundle_adjustment.calibrate_color_offset = unknown == Unknown::COLOR_OFFSET;
  options.bundle_adjustment.calibrate_depth_distortion = unknown == Unknown::DEPTH_DISTORTION;
  const pipeline::SessionRefinement refined = pipeline::refineSessionBy(store.get(), session.id, options, control);
  if (!refined.status.ok())
    throw base::Error(refined.status.code, recording + ": " + refined.status.message +
                                               "; record an object and a table with texture, once round");
  return *refined.bundle_adjustment;
}

void findColorOffset(const CalibrateCameraArguments& arguments, rgbd::SensorNoiseModel* model, CommandOutput* output,
                     base::JobControl& control)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2);
  model->color_offset_x_px = model->color_offset_y_px = 0;
  Eigen::AlignedBox2d found;
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  for (const std::string& recording : arguments.recordings)
  {
    const Eigen::Vector2d found_px =
        adjusted(recording, *model, Unknown::COLOR_OFFSET, arguments, control).color_offset_px;
    text << "offset    (" << found_px.x() << ", " << found_px.y() << ") px: " << recording << "\n";
    output->json["recordings"].push_back(
        { { "recording", recording }, { "color_offset_px", { found_px.x(), found_px.y() } } });
    mean_px += found_px / static_cast<double>(arguments.recordings.size());
    found.extend(found_px);
  }
  const double spread_px = found.diagonal().norm();
  if (arguments.recordings.size() > 1)
    text << "mean      (" << mean_px.x() << ", " << mean_px.y() << ") px; recordings differ by up to " << spread_px
         << " px\n";
  else
    text << "note      one recording does not tell how right it is; give two or more\n";
  if (spread_px > MAX_SPREAD_PX)
    text << "warning   they do not agree: leave out those of plain or flat scenes, which tell little\n";
  model->color_offset_x_px = mean_px.x();
  model->color_offset_y_px = mean_px.y();
  output->json["color_offset_px"] = { mean_px.x(), mean_px.y() };
  output->json["spread_px"] = spread_px;
  output->text += text.str();
}

/// What depth is distorted by besides what the model has.
void findDepthDistortion(const CalibrateCameraArguments& arguments, rgbd::SensorNoiseModel* model,
                         CommandOutput* output, base::JobControl& control)
{
  std::vector<calibration::DistortionEstimate> estimates;
  for (const std::string& recording : arguments.recordings)
  {
    const rgbd::SensorCorrection sensor =
        adjusted(recording, *model, Unknown::DEPTH_DISTORTION, arguments, control).sensor;
    estimates.push_back({ sensor.depth_distortion_ratio, sensor.depth_distortion_sigma_ratio });
  }
  const calibration::DistortionMean mean = calibration::meanDistortion(estimates);
  std::ostringstream text;
  text << std::setprecision(2) << "distorted by " << 100 * mean.size_ratio << " % of depth (RMS); recordings differ by "
       << 100 * mean.disagreement_ratio << " %: " << (mean.agrees ? "taken off" : "not taken, they do not agree")
       << "\n";
  if (!mean.agrees)
    text << "note      record once round, 10 s or more, with texture on the table in all of the view; give three or "
            "more\n";
  if (mean.agrees)
    for (std::size_t i = 0; i < mean.ratio.size(); ++i)
      model->depth_distortion_ratio[i] += mean.ratio[i];
  output->json["depth_distortion"] = { { "size_ratio", mean.size_ratio },
                                       { "disagreement_ratio", mean.disagreement_ratio },
                                       { "agrees", mean.agrees } };
  output->text += text.str();
}

CommandOutput run(const CalibrateCameraArguments& arguments, base::JobControl& control)
{
  requireOutputFolder(arguments.output);
  rgbd::SensorNoiseModel model = recordOptions(arguments.record).frame.noise_model;
  CommandOutput output;
  findColorOffset(arguments, &model, &output, control);
  if (arguments.recordings.size() > 1)
    findDepthDistortion(arguments, &model, &output, control);
  control.checkCancelled();
  rgbd::saveNoiseModel(
      arguments.output, base::checked(model),
      "Colour offset and depth distortion found by bundle adjustment; docs/noise_model.md\n" + output.text);
  output.text += "written   " + arguments.output + "\n";
  output.json["output"] = arguments.output;
  return output;
}
}  // namespace

void addCalibrateCameraCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<CalibrateCameraArguments>();
  CLI::App* command =
      app.add_subcommand("calibrate_camera",
                         "By how much a camera's colour images are shifted against its depth images, and what "
                         "its depth is distorted by");
  command
      ->add_option(
          "recordings", arguments->recordings,
          "TUM-style folders or ROS bags of one camera: once round an object, with texture on it and its table. "
          "Two or more tell the distortion too")
      ->required();
  command
      ->add_option(
          "--output", arguments->output,
          "YAML for --noise-model and the nodes' parameter noise_model; the rest in it is that of --noise-model")
      ->capture_default_str();
  addTrackingOptions(*command, &arguments->record);
  command->footer(
      "Example: object_modelling calibrate_camera mug.bag bottle.bag --noise-model xtion.yaml --output xtion.yaml");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
