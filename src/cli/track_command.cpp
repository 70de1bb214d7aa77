#include <memory>

#include "command.h"
#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/ros_bridge/recording.h"
#include "object_modelling/source/trajectory_correction.h"
#include "report_text.h"
#include "temporary_store.h"

namespace object_modelling::cli
{
namespace
{
struct TrackArguments
{
  std::string recording;
  std::string trajectory;
  std::string refined_trajectory;
  RecordArguments record;
};

CommandOutput run(const TrackArguments& arguments, base::JobControl& control)
{
  const std::unique_ptr<source::FrameSource> source = ros_bridge::openRecording(arguments.recording);
  pipeline::RecordOptions options = recordOptions(arguments.record);
  const bool refine = !arguments.refined_trajectory.empty();
  std::unique_ptr<TemporaryStore> store;
  if (refine)
    store = std::make_unique<TemporaryStore>();
  keyframes::Session session;
  session.id = sessionIdFrom(arguments.recording);

  CommandOutput output;
  const pipeline::RecordReport report =
      pipeline::recordSession(*source, session, refine ? &store->get() : nullptr, options, control);
  if (!arguments.trajectory.empty())
    source::writeTrajectory(arguments.trajectory, report.trajectory);
  output.text = toText(report);
  output.json = toJson(report);
  if (!refine)
    return output;

  const std::vector<rgbd::Keyframe> before = keyframes::loadKeyframes(store->get(), session.id);
  const pipeline::SessionRefinement refined =
      pipeline::refineSessionBy(store->get(), session.id, refinementOptions(arguments.record), control);
  output.text += toText(refined);
  output.json["refinement"] = toJson(refined);
  if (!refined.status.ok())
    throw base::Error(refined.status.code, refined.status.message);
  std::vector<double> stamps_s;
  std::vector<Eigen::Isometry3d> poses_before;
  for (const rgbd::Keyframe& keyframe : before)
  {
    stamps_s.push_back(keyframe.frame.stamp_s);
    poses_before.push_back(keyframe.T_session_camera);
  }
  source::writeTrajectory(
      arguments.refined_trajectory,
      source::correctTrajectory(report.trajectory, stamps_s, poses_before, refined.T_session_camera));
  return output;
}
}  // namespace

void addTrackCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<TrackArguments>();
  CLI::App* command = app.add_subcommand("track", "Camera trajectory of a recording");
  command
      ->add_option("recording", arguments->recording, "TUM-style folder (rgb.txt, depth.txt, camera.yaml) or ROS bag")
      ->required();
  command->add_option("--trajectory", arguments->trajectory,
                      "Write session_from_camera of every tracked frame, TUM format, as it was known live");
  command->add_option("--refined-trajectory", arguments->refined_trajectory,
                      "Refine the keyframes (--refinement) and write the trajectory that follows from them");
  addRecordOptions(*command, &arguments->record);
  command->footer(
      "Example: object_modelling track my_recording --trajectory live.txt --refined-trajectory refined.txt");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
