// Time and memory of every stage from tracked keyframes to the model, for sessions of different length.
// benchmark_session --help; docs/measurements.md.
#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "benchmark_program.h"
#include "object_modelling/pipeline/align_sessions.h"
#include "object_modelling/pipeline/build_object.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/pipeline/session_refinement.h"
#include "support/temp_dir.h"
#include "tracking_run.h"

namespace
{
using namespace object_modelling;

const std::vector<std::string> STAGES = { "bundle adjustment", "multi-view ICP", "segment",    "load",     "fuse",
                                          "surface",           "texture",        "properties", "describe", "write" };

constexpr char SESSION_ID[] = "session";

struct Arguments
{
  std::string recording, json;
  std::vector<std::size_t> keyframes = { 30, 60, 120, 240 };
  double keyframe_angle_deg = 1.5;
  int repeat = 1;
};

struct SessionCost
{
  std::size_t keyframes = 0;
  std::map<std::string, double> stage_s;
  double peak_mb = 0;
};

void require(const base::Status& status)
{
  if (!status.ok())
    throw base::Error(status.code, status.message);
}

/// A session of `count` of the tracked keyframes, evenly chosen, through all stages, in a store and a database of its
/// own.
SessionCost measureSession(keyframes::SessionStore& tracked, std::size_t count)
{
  const test_support::TempDir folder;
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(folder.path("store.sqlite"));
  keyframes::Session session;
  session.id = SESSION_ID;
  store->createSession(session);
  const std::vector<int> ids = tracked.keyframeIds(SESSION_ID);
  for (std::size_t i = 0; i < count; ++i)
    store->addKeyframe(SESSION_ID, tracked.keyframe(SESSION_ID, ids[i * ids.size() / count]));
  database::ObjectDatabase database(folder.path("objects"), true);

  SessionCost cost;
  cost.keyframes = count;
  base::JobControl control;
  const auto timed = [&](const std::string& stage, const auto& work)
  {
    const auto start = std::chrono::steady_clock::now();
    require(work());
    cost.stage_s[stage] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  benchmark_tracking::resetPeakMemory();
  pipeline::RefinementOptions refinement;
  refinement.multi_view_icp.start_error_m = pipeline::AFTER_BUNDLE_M;
  refinement.method = pipeline::RefinementMethod::BUNDLE_ADJUSTMENT;
  timed("bundle adjustment", [&] { return pipeline::refineSessionBy(*store, session.id, refinement, control).status; });
  refinement.method = pipeline::RefinementMethod::MULTI_VIEW_ICP;
  timed("multi-view ICP", [&] { return pipeline::refineSessionBy(*store, session.id, refinement, control).status; });
  timed("segment",
        [&] { return pipeline::segmentStoredSession(*store, session.id, std::nullopt, {}, control).status; });
  pipeline::BuildOptions options;
  options.make_report = false;
  const alignment::AlignmentResult aligned = pipeline::alignStoredSessions(*store, { session.id }, {}, control);
  const pipeline::BuildReport built =
      pipeline::buildObject(*store, database, "object", "", aligned.placements, options, control);
  require(built.status);
  for (const pipeline::StageTime& time : built.stages)
    cost.stage_s[time.stage] = time.duration_s;
  cost.peak_mb = benchmark_tracking::peakMemory_mb();
  return cost;
}

/// Stage by stage the median.
SessionCost medianOf(const std::vector<SessionCost>& runs)
{
  SessionCost median = runs.front();
  for (auto& [stage, seconds] : median.stage_s)
  {
    std::vector<double> values;
    for (const SessionCost& run : runs)
      values.push_back(run.stage_s.at(stage));
    std::sort(values.begin(), values.end());
    seconds = values[values.size() / 2];
  }
  return median;
}

/// Tracks the recording; its keyframes are in the store then, and out of memory. Returns how many.
std::size_t track(const Arguments& arguments, keyframes::SessionStore* store)
{
  benchmark_tracking::RunOptions options;
  options.keep_keyframes = true;
  options.keyframe_angle_rad = arguments.keyframe_angle_deg * M_PI / 180;
  const benchmark_tracking::Run run = benchmark_tracking::trackRecording(arguments.recording, options);
  keyframes::Session session;
  session.id = SESSION_ID;
  store->createSession(session);
  for (const rgbd::Keyframe& keyframe : run.keyframes)
    store->addKeyframe(SESSION_ID, keyframe);
  return run.keyframes.size();
}

void run(const Arguments& arguments)
{
  const test_support::TempDir folder;
  const std::unique_ptr<keyframes::SessionStore> tracked = keyframes::openSqlStore(folder.path("tracked.sqlite"));
  const std::size_t tracked_count = track(arguments, tracked.get());
  std::cout << tracked_count << " keyframes tracked; seconds:\n\n| keyframes |";
  for (const std::string& stage : STAGES)
    std::cout << " " << stage << " |";
  std::cout << " peak MB |\n|";
  for (std::size_t i = 0; i < STAGES.size() + 2; ++i)
    std::cout << "---|";
  std::cout << "\n" << std::flush;
  nlohmann::json json = nlohmann::json::array();
  for (const std::size_t count : arguments.keyframes)
  {
    if (count == 0 || count > tracked_count)
      throw base::Error(base::StatusCode::INVALID_ARGUMENT, "--keyframes " + std::to_string(count) +
                                                                ": the recording has " + std::to_string(tracked_count) +
                                                                "; lower --keyframe-angle");
    std::vector<SessionCost> runs;
    for (int i = 0; i < arguments.repeat; ++i)
      runs.push_back(measureSession(*tracked, count));
    const SessionCost cost = medianOf(runs);
    std::cout << "| " << cost.keyframes << " |" << std::fixed << std::setprecision(2);
    for (const std::string& stage : STAGES)
      std::cout << " " << cost.stage_s.at(stage) << " |";
    std::cout << std::setprecision(0) << " " << cost.peak_mb << " |\n" << std::flush;
    json.push_back({ { "keyframes", cost.keyframes }, { "stage_s", cost.stage_s }, { "peak_mb", cost.peak_mb } });
  }
  benchmark_program::writeJson(arguments.json, json);
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Time of every stage from tracked keyframes to the model, and memory, by length of the session.");
  app.footer("Keyframes are chosen evenly from those tracked. Exit codes: 1 failed, 2 wrong usage.");
  Arguments arguments;
  app.add_option("recording", arguments.recording, "TUM-style folder")->required()->check(CLI::ExistingDirectory);
  app.add_option("--keyframes", arguments.keyframes, "Lengths of the session, one row each")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--keyframe-angle", arguments.keyframe_angle_deg, "Degrees between the keyframes that are tracked")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--repeat", arguments.repeat, "Runs; times are their medians")->check(CLI::PositiveNumber);
  app.add_option("--json", arguments.json, "Also write the figures to this file (plot_session.py)");
  return benchmark_program::run(app, argc, argv, [&] { run(arguments); });
}
