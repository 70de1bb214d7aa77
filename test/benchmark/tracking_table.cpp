#include "tracking_report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "tracking_times.h"

namespace object_modelling::benchmark_tracking
{
namespace
{
std::string shortName(const std::string& recording)
{
  const std::size_t slash = recording.find_last_of('/');
  const std::size_t parent = slash == std::string::npos ? slash : recording.find_last_of('/', slash - 1);
  return parent == std::string::npos ? recording : recording.substr(parent + 1);
}

std::string number(double value, int digits)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

std::string row(const std::vector<std::string>& cells)
{
  std::string line = "|";
  for (const std::string& cell : cells)
    line += " " + cell + " |";
  return line + "\n";
}

std::string header(const std::vector<std::string>& cells)
{
  return row(cells) + row(std::vector<std::string>(cells.size(), "---"));
}

std::string framesText(const std::optional<int>& frames)
{
  return frames ? std::to_string(*frames) : "never";
}

std::vector<std::string> accuracyCells(const RecordingReport& report)
{
  const Run& run = report.runs.front();
  std::vector<std::string> cells = { shortName(report.recording), std::to_string(frameCount(report)),
                                     number(100.0 * trackedCount(report) / std::max(1, frameCount(report)), 1),
                                     std::to_string(keyframeCount(run)), std::to_string(relocalisedCount(run)) };
  if (report.live)
  {
    const TrajectoryScore& live = *report.live;
    cells.insert(cells.end(), { number(live.ate_mm.rmse, 2), number(live.ate_mm.max, 2),
                                live.rpe_mm ? number(live.rpe_mm->rmse, 2) : "",
                                live.rpe_deg ? number(live.rpe_deg->rmse, 3) : "", std::to_string(live.wrong) });
  }
  else
    cells.insert(cells.end(), 5, "");
  cells.push_back(report.nees && report.nees->count > 0 ? number(100 * report.nees->within_ratio, 1) : "");
  cells.push_back(report.refined_score ? number(report.refined_score->ate_mm.rmse, 2) : "");
  cells.push_back(report.refined ? number(report.refined->cpu_s, 1) : "");
  cells.push_back(number(run.rss_mb, 0) + " / " + number(run.peak_rss_mb, 0));
  std::string events;
  if (report.live)
    for (const Relocalisation& relocalisation : report.live->relocalisations)
      events += (events.empty() ? "" : ", ") + relocalisation.event.type + " " +
                framesText(relocalisation.frames_to_pose) + " (" + framesText(relocalisation.frames_to_right_pose) +
                ")";
  cells.push_back(events);
  return cells;
}
}  // namespace

std::string toTable(const std::vector<RecordingReport>& reports)
{
  std::string text = header({ "recording", "frames", "tracked %", "keyframes", "relocalised", "ATE mm", "max mm",
                              "RPE mm/s", "RPE deg/s", "wrong", "NEES in 95 % bound", "refined ATE mm",
                              "refinement CPU s", "RSS / peak MB", "frames after event (to right pose)" });
  for (const RecordingReport& report : reports)
    text += row(accuracyCells(report));
  text += "\nms per frame, median / p95 / max" +
          std::string(reports.front().runs.size() > 1 ? " (each the median of the runs)" : "") +
          "; stages in wall time\n\n";
  std::vector<std::string> names = { "recording" };
  for (const auto& [name, times] : timeTable(reports.front().runs))
    names.push_back(name);
  text += header(names);
  for (const RecordingReport& report : reports)
  {
    std::vector<std::string> cells = { shortName(report.recording) };
    for (const auto& [name, times] : timeTable(report.runs))
      cells.push_back(number(times.median_ms, 1) + " / " + number(times.p95_ms, 1) + " / " + number(times.max_ms, 1));
    text += row(cells);
  }
  for (const RecordingReport& report : reports)
  {
    if (report.live && report.live->ate_by_minute_mm.size() > 2)
    {
      text += "\n" + shortName(report.recording) + ": ATE by minute";
      for (const double ate_mm : report.live->ate_by_minute_mm)
        text += " " + number(ate_mm, 2);
      text += " mm\n";
    }
    if (!report.repeatable)
      text += "\n" + shortName(report.recording) + ": the runs gave different poses\n";
    if (report.refined && !report.refined->problem.empty())
      text += "\n" + shortName(report.recording) + ": not refined: " + report.refined->problem + "\n";
  }
  return text;
}

std::string toLines(const Run& run)
{
  std::ostringstream out;
  out << std::fixed;
  for (const FrameRecord& frame : run.frames)
  {
    const tracking::TrackingResult& result = frame.result;
    out << std::setprecision(6) << result.stamp_s << " " << toString(result.status) << " inliers "
        << result.inlier_count << " of " << result.feature_count << std::setprecision(2) << ", "
        << result.reprojection_rmse_px << " px, blur " << result.blur_ratio << ", " << frame.wall_ms << " ms ("
        << frame.cpu_ms << " CPU)" << (frame.keyframe ? ", keyframe" : "") << " " << result.reason << "\n";
  }
  return out.str();
}

}  // namespace object_modelling::benchmark_tracking
