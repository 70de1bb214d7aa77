#include "report_text.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "object_modelling/base/statistics.h"

namespace object_modelling::cli
{
namespace
{
constexpr double DEG_PER_RAD = 180 / M_PI;

std::ostringstream fixedText(int digits)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits);
  return out;
}

/// Of an object that was there before.
std::string frameText(const pipeline::BuildReport& report)
{
  if (report.frame.by != "alignment")
    return {};
  std::ostringstream out = fixedText(2);
  out << "          its frame is kept: aligned with the stored model (probability " << report.frame.probability
      << ")\n";
  return out.str();
}
}  // namespace

nlohmann::json toJson(const base::Status& status)
{
  return { { "code", static_cast<int>(status.code) }, { "message", status.message } };
}

nlohmann::json toJson(const pipeline::RecordReport& report)
{
  return { { "session_id", report.session_id },
           { "frame_count", report.frame_count },
           { "tracked_count", report.tracked_count },
           { "tracked_ratio", report.trackedRatio() },
           { "unusable_count", report.unusable_count },
           { "lost_count", report.lost_count },
           { "relocalised_count", report.relocalised_count },
           { "keyframe_count", report.keyframe_count },
           { "track_median_ms", base::quantile(report.track_ms, 0.5) },
           { "track_p95_ms", base::quantile(report.track_ms, 0.95) },
           { "first_problem", report.first_problem } };
}

nlohmann::json toJson(const bundle_adjustment::BundleAdjustmentResult& result)
{
  nlohmann::json keyframes = nlohmann::json::array();
  for (const bundle_adjustment::KeyframeResidual& residual : result.residuals)
  {
    nlohmann::json fields;
    bundle_adjustment::forFields([&](const char* name, const auto& value) { fields[name] = value; }, residual);
    keyframes.push_back(fields);
  }
  nlohmann::json links = nlohmann::json::array();
  for (const bundle_adjustment::KeyframeLink& link : result.links)
    links.push_back({ { "keyframe_a", link.keyframe_a },
                      { "keyframe_b", link.keyframe_b },
                      { "inlier_count", link.inlier_count },
                      { "translation_error_before_mm", link.translation_error_before_m * 1000 },
                      { "translation_error_after_mm", link.translation_error_after_m * 1000 },
                      { "rotation_error_before_deg", link.rotation_error_before_rad * DEG_PER_RAD },
                      { "rotation_error_after_deg", link.rotation_error_after_rad * DEG_PER_RAD } });
  return { { "status", toJson(result.status) },
           { "iterations", result.iterations },
           { "initial_cost", result.initial_cost },
           { "final_cost", result.final_cost },
           { "color_offset_px", { result.color_offset_px.x(), result.color_offset_px.y() } },
           { "left_out", result.left_out },
           { "keyframes", keyframes },
           { "links", links } };
}

nlohmann::json toJson(const pipeline::SegmentReport& report)
{
  return { { "status", toJson(report.status) },
           { "keyframe_count", report.keyframe_count },
           { "masked_count", report.masked_count },
           { "support_plane_found", report.support_plane_found } };
}

nlohmann::json stageSeconds(const std::vector<pipeline::StageTime>& stages)
{
  nlohmann::json seconds = nlohmann::json::object();
  for (const pipeline::StageTime& time : stages)
    seconds[time.stage] = time.duration_s;
  return seconds;
}

nlohmann::json toJson(const pipeline::BuildReport& report)
{
  nlohmann::json looks_like = nlohmann::json::array();
  for (const report::SimilarObject& similar : report.looks_like)
    looks_like.push_back({ { "object_id", similar.object_id }, { "probability", similar.probability } });
  return {
    { "status", toJson(report.status) },
    { "object_folder", report.object_folder },
    { "preview_path", report.preview_path },
    { "size_m", { report.size_m.x(), report.size_m.y(), report.size_m.z() } },
    { "diameter_m", report.diameter_m },
    { "point_count", report.point_count },
    { "vertex_count", report.vertex_count },
    { "triangle_count", report.triangle_count },
    { "properties", report.properties },
    { "stage_s", stageSeconds(report.stages) },
    { "looks_like", looks_like },
    { "frame",
      { { "version", report.frame_version }, { "by", report.frame.by }, { "probability", report.frame.probability } } }
  };
}

std::string toText(const pipeline::RecordReport& report)
{
  std::ostringstream out = fixedText(1);
  out << "tracked   " << report.tracked_count << " of " << report.frame_count << " frames ("
      << 100 * report.trackedRatio() << " %), " << report.keyframe_count << " keyframes, lost " << report.lost_count
      << " times, relocalised " << report.relocalised_count << "; " << base::quantile(report.track_ms, 0.5)
      << " ms per frame median, " << base::quantile(report.track_ms, 0.95) << " ms p95\n";
  if (!report.first_problem.empty())
    out << "          first problem: " << report.first_problem << "\n";
  return out.str();
}

std::string toText(const pipeline::SegmentReport& report)
{
  std::ostringstream out;
  if (!report.status.ok())
    return "segmented " + report.status.message + "\n";
  out << "segmented " << report.masked_count << " of " << report.keyframe_count
      << " keyframes see the object; support plane " << (report.support_plane_found ? "found" : "not found") << "\n";
  return out.str();
}

std::string toText(const pipeline::BuildReport& report)
{
  if (!report.status.ok())
    return "built     " + report.status.message + "\n";
  std::ostringstream out = fixedText(1);
  out << "built     " << 1000 * report.size_m.x() << " x " << 1000 * report.size_m.y() << " x "
      << 1000 * report.size_m.z() << " mm, diameter " << 1000 * report.diameter_m << " mm; " << report.point_count
      << " points, " << report.triangle_count << " triangles\n"
      << "          " << report.properties << "\n"
      << frameText(report) << "          " << report.object_folder << "\n"
      << "          " << report.preview_path << "\n";
  if (!report.status.message.empty())
    out << "WARNING   " << report.status.message << "\n";
  return out.str();
}

}  // namespace object_modelling::cli
