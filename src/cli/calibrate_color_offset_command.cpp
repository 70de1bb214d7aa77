#include <iomanip>
#include <memory>
#include <sstream>

#include <Eigen/Geometry>

#include "command.h"
#include "object_modelling/base/options.h"
#include "object_modelling/rgbd/noise_model_file.h"
#include "object_modelling/ros_bridge/recording.h"
#include "temporary_store.h"

namespace object_modelling::cli
{
namespace
{
constexpr double MAX_SPREAD_PX = 0.15;  // half of what a flat scene errs by

struct Arguments
{
  std::vector<std::string> recordings;
  std::string output = "noise.yaml";
  RecordArguments record;
};

/// What one recording says.
Eigen::Vector2d offset_px(const std::string& recording, const RecordArguments& arguments, base::JobControl& control)
{
  const std::unique_ptr<source::FrameSource> source = ros_bridge::openRecording(recording);
  TemporaryStore store;
  keyframes::Session session;
  session.id = sessionIdFrom(recording);
  pipeline::RecordOptions record = recordOptions(arguments);
  record.frame.noise_model.color_offset_x_px = record.frame.noise_model.color_offset_y_px = 0;
  pipeline::recordSession(*source, session, &store.get(), record, control);
  pipeline::RefinementOptions options = refinementOptions(arguments);
  options.method = pipeline::RefinementMethod::BUNDLE_ADJUSTMENT;
  options.bundle_adjustment.calibrate_color_offset = true;
  const pipeline::SessionRefinement refined = pipeline::refineSessionBy(store.get(), session.id, options, control);
  if (!refined.status.ok())
    throw base::Error(refined.status.code, recording + ": " + refined.status.message +
                                               "; record an object and a table with print, once round");
  return refined.bundle_adjustment->color_offset_px;
}

CommandOutput run(const Arguments& arguments, base::JobControl& control)
{
  requireOutputFolder(arguments.output);
  rgbd::SensorNoiseModel model = recordOptions(arguments.record).frame.noise_model;
  CommandOutput output;
  std::ostringstream text;
  text << std::fixed << std::setprecision(2);
  Eigen::AlignedBox2d found;
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  for (const std::string& recording : arguments.recordings)
  {
    const Eigen::Vector2d found_px = offset_px(recording, arguments.record, control);
    text << "offset    (" << found_px.x() << ", " << found_px.y() << ") px: " << recording << "\n";
    output.json["recordings"].push_back(
        { { "recording", recording }, { "color_offset_px", { found_px.x(), found_px.y() } } });
    sum_px += found_px;
    found.extend(found_px);
  }
  const Eigen::Vector2d mean_px = sum_px / static_cast<double>(arguments.recordings.size());
  const double spread_px = found.diagonal().norm();
  if (arguments.recordings.size() > 1)
    text << "mean      (" << mean_px.x() << ", " << mean_px.y() << ") px; recordings differ by up to " << spread_px
         << " px\n";
  else
    text << "note      one recording does not tell how right it is; give two or more\n";
  if (spread_px > MAX_SPREAD_PX)
    text << "warning   they do not agree: leave out those of plain or flat scenes, which tell little\n";
  control.checkCancelled();
  model.color_offset_x_px = mean_px.x();
  model.color_offset_y_px = mean_px.y();
  rgbd::saveNoiseModel(arguments.output, base::checked(model),
                       "Colour offset found by bundle adjustment; docs/noise_model.md\n" + text.str());
  text << "written   " << arguments.output << "\n";
  output.text = text.str();
  output.json["color_offset_px"] = { mean_px.x(), mean_px.y() };
  output.json["spread_px"] = spread_px;
  output.json["output"] = arguments.output;
  return output;
}
}  // namespace

void addCalibrateColorOffsetCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("calibrate_color_offset",
                                         "By how much a sensor's colour images are shifted against its depth images");
  command
      ->add_option("recordings", arguments->recordings,
                   "TUM-style folders or ROS bags of one sensor: once round an object, with print on it or its table")
      ->required();
  command
      ->add_option(
          "--output", arguments->output,
          "YAML for --noise-model and the nodes' parameter noise_model; the rest in it is that of --noise-model")
      ->capture_default_str();
  addTrackingOptions(*command, &arguments->record);
  command->footer(
      "Example: object_modelling calibrate_color_offset mug.bag --noise-model xtion.yaml --output xtion.yaml");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
