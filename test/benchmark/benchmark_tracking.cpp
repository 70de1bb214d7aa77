// Tracks recordings and prints what came of it as tables: share of frames tracked, errors against the truth, time by
// stage, memory. benchmark_tracking --help; docs/tracking.md.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "benchmark_program.h"
#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/noise_model_file.h"
#include "tracking_report.h"

namespace
{
using namespace object_modelling;
using namespace object_modelling::benchmark_tracking;

struct Arguments
{
  std::vector<std::string> recordings;
  RunOptions run;
  bool refine = false, events = false, verbose = false;
  int repeat = 1;
  std::string noise_model, out, json;
};

std::vector<Event> readEvents(const std::string& path)
{
  std::vector<Event> events;
  try
  {
    for (const YAML::Node& event : YAML::LoadFile(path)["events"])
      events.push_back({ event["type"].as<std::string>(), event["start"].as<double>(), event["end"].as<double>() });
  }
  catch (const YAML::Exception& error)
  {
    throw base::Error(base::StatusCode::BAD_INPUT, "'" + path + "': " + error.what());
  }
  return events;
}

bool samePoses(const Run& a, const Run& b)
{
  return std::equal(a.frames.begin(), a.frames.end(), b.frames.begin(), b.frames.end(),
                    [](const FrameRecord& x, const FrameRecord& y)
                    {
                      return x.result.status == y.result.status &&
                             x.result.T_session_camera.matrix() == y.result.T_session_camera.matrix();
                    });
}

void compareWithTruth(const std::vector<source::StampedPose>& truth, RecordingReport* report)
{
  const Run& run = report->runs.front();
  std::vector<double> stamps_s;
  std::vector<EstimateWithCovariance> estimate;
  for (const FrameRecord& frame : run.frames)
  {
    stamps_s.push_back(frame.result.stamp_s);
    if (frame.result.tracked())
      estimate.push_back({ { frame.result.stamp_s, frame.result.T_session_camera }, frame.result.covariance });
  }
  report->live = scoreTrajectory(run.trajectory(), truth, report->events, stamps_s);
  report->nees = neesOf(estimate, truth, ScoreOptions().tolerance_s);
  if (report->refined)
    report->refined_score = scoreTrajectory(report->refined->trajectory, truth, report->events, stamps_s);
}

/// Folder and name for the trajectory files of a recording: its last two path components, since "session_1" is not
/// unique.
std::string outputBase(const std::string& out, const std::string& recording)
{
  const std::filesystem::path path = std::filesystem::absolute(recording).lexically_normal();
  return out + "/" + path.parent_path().filename().string() + "_" + path.filename().string();
}

RecordingReport measure(const std::string& recording, const Arguments& arguments)
{
  RecordingReport report;
  report.recording = recording;
  RunOptions options = arguments.run;
  for (int i = 0; i < arguments.repeat; ++i)
  {
    options.keep_keyframes = arguments.refine && i == 0;
    report.runs.push_back(trackRecording(recording, options));
    report.repeatable &= samePoses(report.runs.front(), report.runs.back());
  }
  Run& run = report.runs.front();
  if (arguments.refine)
    report.refined = refineRun(run, options);
  run.keyframes.clear();
  if (arguments.events && std::filesystem::exists(recording + "/events.yaml"))
    report.events = readEvents(recording + "/events.yaml");
  if (std::filesystem::exists(recording + "/groundtruth.txt"))
    compareWithTruth(source::readTrajectory(recording + "/groundtruth.txt"), &report);
  if (!arguments.out.empty())
  {
    report.trajectory_path = outputBase(arguments.out, recording) + ".txt";
    source::writeTrajectory(report.trajectory_path, run.trajectory());
    if (report.refined && report.refined->problem.empty())
    {
      report.refined_path = outputBase(arguments.out, recording) + "_refined.txt";
      source::writeTrajectory(report.refined_path, report.refined->trajectory);
    }
  }
  return report;
}

void run(const Arguments& arguments)
{
  std::vector<RecordingReport> reports;
  nlohmann::json json;
  for (std::string recording : arguments.recordings)
  {
    while (recording.size() > 1 && recording.back() == '/')
      recording.pop_back();
    reports.push_back(measure(recording, arguments));
    if (arguments.verbose)
      std::cout << toLines(reports.back().runs.front()) << "\n";
    json["recordings"].push_back(toJson(reports.back()));
  }
  std::cout << toTable(reports);
  benchmark_program::writeJson(arguments.json, json);
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Accuracy, time and memory of the camera tracker on TUM-style recordings.");
  app.footer(
      "Times are of the tracker alone; start it under 'taskset -c 0' to measure one core. Errors are those of the TUM\n"
      "benchmark, after rigid alignment; a pose is wrong if it is off by more than 20 mm or 3 degrees. NEES: share of\n"
      "poses whose error, against their covariance, is within the 95 % bound. Exit codes: 1 failed, 2 wrong usage.");
  Arguments arguments;
  app.add_option("recordings", arguments.recordings, "TUM-style folders; errors where they have groundtruth.txt")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_flag("--object", arguments.run.object_reference, "Track the object on the masks, not the scene");
  app.add_flag("--refine", arguments.refine, "Also refine the keyframes, and score what follows for all frames");
  app.add_flag("--events", arguments.events, "Count frames after each event of events.yaml; align before the first");
  app.add_option("--every", arguments.run.every, "Only every Nth frame, as when frames are dropped")
      ->check(CLI::PositiveNumber);
  app.add_option("--skip", arguments.run.skip, "Leave out the first N frames")->check(CLI::NonNegativeNumber);
  app.add_option("--seed", arguments.run.seed, "Of the tracker's random choices");
  app.add_option("--noise-model", arguments.noise_model, "YAML of the sensor, as calibrate_camera writes it")
      ->check(CLI::ExistingFile);
  app.add_option("--repeat", arguments.repeat, "Runs; times are the medians of theirs")->check(CLI::PositiveNumber);
  app.add_option("--out", arguments.out, "Folder for trajectories")->check(CLI::ExistingDirectory);
  app.add_option("--json", arguments.json, "Also write all figures, and series by frame, to this file");
  app.add_flag("--verbose", arguments.verbose, "One line per frame");
  return benchmark_program::run(app, argc, argv,
                                [&]
                                {
                                  if (!arguments.noise_model.empty())
                                    arguments.run.noise_model = rgbd::loadNoiseModel(arguments.noise_model);
                                  run(arguments);
                                });
}
