#include "tracking_report.h"

#include <cmath>

#include "tracking_times.h"

namespace object_modelling::benchmark_tracking
{
namespace
{
using nlohmann::json;

/// As many digits as score_trajectory.py gives.
double rounded(double value)
{
  return std::round(1000 * value) / 1000;
}

json toJson(const Statistics& statistics)
{
  return { { "rmse", rounded(statistics.rmse) },
           { "mean", rounded(statistics.mean) },
           { "median", rounded(statistics.median) },
           { "max", rounded(statistics.max) } };
}

template <typename T>
json orNull(const std::optional<T>& value)
{
  return value ? json(*value) : json();
}

json toJson(const std::optional<TrajectoryScore>& score)
{
  if (!score)
    return nullptr;
  json result = { { "matched", score->matched },
                  { "wrong", score->wrong },
                  { "ate_mm", toJson(score->ate_mm) },
                  { "ate_by_minute_mm", score->ate_by_minute_mm },
                  { "rotation_deg", toJson(score->rotation_deg) },
                  { "rpe_mm", score->rpe_mm ? toJson(*score->rpe_mm) : json() },
                  { "rpe_deg", score->rpe_deg ? toJson(*score->rpe_deg) : json() } };
  for (const Relocalisation& relocalisation : score->relocalisations)
    result["relocalisation"].push_back({ { "type", relocalisation.event.type },
                                         { "start", relocalisation.event.start_s },
                                         { "end", relocalisation.event.end_s },
                                         { "frames_to_pose", orNull(relocalisation.frames_to_pose) },
                                         { "frames_to_right_pose", orNull(relocalisation.frames_to_right_pose) } });
  return result;
}

json vectorJson(const Eigen::Vector3d& v)
{
  return { v.x(), v.y(), v.z() };
}

/// Per frame, and per pose compared with the truth: what plot_tracking.py draws.
json frameSeries(const Run& run)
{
  json frames = json::array();
  for (const FrameRecord& frame : run.frames)
  {
    json entry = { { "stamp", frame.result.stamp_s },        { "status", toString(frame.result.status) },
                   { "inliers", frame.result.inlier_count }, { "keyframe", frame.keyframe },
                   { "wall_ms", rounded(frame.wall_ms) },    { "cpu_ms", rounded(frame.cpu_ms) } };
    for (const auto& [name, stage_ms] : stageTimes(frame))
      entry["stages_ms"][name] = rounded(stage_ms);
    frames.push_back(entry);
  }
  return frames;
}

json poseSeries(const std::optional<TrajectoryScore>& score)
{
  json poses = json::array();
  if (score)
    for (const TrajectoryScore::Pair& pair : score->pairs)
      poses.push_back({ { "stamp", pair.stamp_s },
                        { "position", vectorJson(pair.T_world_camera.translation()) },
                        { "truth", vectorJson(pair.truth.translation()) },
                        { "position_mm", rounded(pair.position_mm) },
                        { "rotation_deg", rounded(pair.rotation_deg) } });
  return poses;
}
}  // namespace

json toJson(const RecordingReport& report)
{
  const Run& run = report.runs.front();
  json result = { { "recording", report.recording },        { "frames", frameCount(report) },
                  { "tracked", trackedCount(report) },      { "unusable", run.unusable },
                  { "keyframes", keyframeCount(run) },      { "relocalised", relocalisedCount(run) },
                  { "repeats", report.runs.size() },        { "repeatable", report.repeatable },
                  { "rss_mb", rounded(run.rss_mb) },        { "peak_rss_mb", rounded(run.peak_rss_mb) },
                  { "trajectory", report.trajectory_path }, { "live", toJson(report.live) } };
  for (const auto& [name, times] : timeTable(report.runs))
  {
    const json entry = { { "median", rounded(times.median_ms) },
                         { "p95", rounded(times.p95_ms) },
                         { "max", rounded(times.max_ms) },
                         { "mean", rounded(times.mean_ms) } };
    if (name == "wall" || name == "cpu")
      result[name + "_ms"] = entry;
    else
      result["stages_ms"][name] = entry;
  }
  if (report.nees)
    result["nees"] = { { "count", report.nees->count },
                       { "within_95_ratio", rounded(report.nees->within_ratio) },
                       { "median", std::isfinite(report.nees->median) ? json(rounded(report.nees->median)) : json() } };
  if (report.refined)
    result["refinement"] = { { "wall_s", rounded(report.refined->wall_s) },
                             { "cpu_s", rounded(report.refined->cpu_s) },
                             { "links", report.refined->links },
                             { "problem", report.refined->problem },
                             { "trajectory", report.refined_path },
                             { "score", toJson(report.refined_score) } };
  result["frame_series"] = frameSeries(run);
  result["pose_series"] = poseSeries(report.live);
  result["refined_pose_series"] = poseSeries(report.refined_score);
  return result;
}

}  // namespace object_modelling::benchmark_tracking
