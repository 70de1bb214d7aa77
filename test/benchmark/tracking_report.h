#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tracking_metrics.h"
#include "tracking_refinement.h"
#include "tracking_run.h"

namespace object_modelling::benchmark_tracking
{
/// All that is known of one recording after its runs; the first run gives the poses, all of them the times.
struct RecordingReport
{
  std::string recording;
  std::string trajectory_path, refined_path;  ///< where they were written; empty if they were not
  std::vector<Run> runs;
  bool repeatable = true;  ///< all runs gave the same poses
  std::vector<Event> events;
  std::optional<TrajectoryScore> live, refined_score;  ///< nothing without groundtruth.txt, or with too few poses
  std::optional<Nees> nees;
  std::optional<Refined> refined;
};

/// Frames outside events, and those of them tracked.
int frameCount(const RecordingReport& report);
int trackedCount(const RecordingReport& report);
int keyframeCount(const Run& run);
int relocalisedCount(const Run& run);

nlohmann::json toJson(const RecordingReport& report);
/// Tables of accuracy and time, one row per recording, Markdown.
std::string toTable(const std::vector<RecordingReport>& reports);
/// One line per frame.
std::string toLines(const Run& run);

}  // namespace object_modelling::benchmark_tracking
