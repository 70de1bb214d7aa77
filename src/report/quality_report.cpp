#include "object_modelling/report/quality_report.h"

#include <algorithm>
#include <cmath>

#include <ceres/version.h>
#include <glog/logging.h>
#include <pcl/pcl_config.h>
#include <opencv2/core/version.hpp>

#include "object_modelling/base/statistics.h"
#include "object_modelling/report/coverage.h"
#include "refinement_yaml.h"

namespace object_modelling::report
{
namespace
{
constexpr int SIGMA_BINS = 40;

template <typename Value>
void put(YAML::Emitter& out, const std::string& key, const Value& value)
{
  out << YAML::Key << key << YAML::Value << value;
}

void begin(YAML::Emitter& out, const std::string& key)
{
  out << YAML::Key << key << YAML::Value << YAML::BeginMap;
}

void emitSigma(YAML::Emitter& out, const std::vector<float>& sigmas_m)
{
  double sum_m = 0;
  for (const float sigma_m : sigmas_m)
    sum_m += sigma_m;
  const double p99_m = base::quantile(sigmas_m, 0.99);
  const double width_m = p99_m > 0 ? p99_m / (SIGMA_BINS - 1) : 1e-4;
  std::vector<int> counts(SIGMA_BINS, 0);
  for (const float sigma_m : sigmas_m)
    if (std::isfinite(sigma_m))
      ++counts[static_cast<std::size_t>(std::clamp(sigma_m / width_m, 0.0, SIGMA_BINS - 1.0))];
  begin(out, "sigma");
  put(out, "mean_m", sigmas_m.empty() ? 0 : sum_m / static_cast<double>(sigmas_m.size()));
  put(out, "median_m", base::quantile(sigmas_m, 0.5));
  put(out, "p95_m", base::quantile(sigmas_m, 0.95));
  put(out, "histogram_bin_width_m", width_m);
  out << YAML::Key << "histogram_counts" << YAML::Value << YAML::Flow << counts;
  out << YAML::EndMap;
}

void emitCoverage(YAML::Emitter& out, const Coverage& coverage)
{
  begin(out, "coverage");
  put(out, "direction_ratio", coverage.direction_ratio);
  put(out, "upper_direction_ratio", coverage.upper_direction_ratio);
  put(out, "mesh_seen_ratio", coverage.seen_ratio);
  put(out, "mesh_seen_by_" + std::to_string(WELL_SEEN_VIEWS) + "_ratio", coverage.well_seen_ratio);
  put(out, "view_cone_rad", VIEW_CONE_RAD);
  out << YAML::Key << "view_counts" << YAML::Value << YAML::BeginSeq;
  for (const auto& row : coverage.view_counts)
    out << YAML::Flow << std::vector<int>(row.begin(), row.end());
  out << YAML::EndSeq << YAML::EndMap;
}

/// A model is worth having without the history of its session.
std::optional<RefinementReport> storedReport(const keyframes::Session& session)
{
  try
  {
    return readRefinementReport(session.refinement_report);
  }
  catch (const base::Error& error)
  {
    LOG(WARNING) << "session '" << session.id << "': " << error.what();
    return std::nullopt;
  }
}

void emitSessions(YAML::Emitter& out, const std::vector<keyframes::Session>& sessions)
{
  out << YAML::Key << "sessions" << YAML::Value << YAML::BeginSeq;
  for (const keyframes::Session& session : sessions)
  {
    out << YAML::BeginMap;
    out << YAML::Key << "id" << YAML::Value << YAML::DoubleQuoted << session.id;
    put(out, "keyframe_count", session.keyframe_count);
    put(out, "tracked_against", session.reference_is_object ? "object" : "scene");
    out << YAML::Key << "refinement" << YAML::Value;
    if (const std::optional<RefinementReport> report = storedReport(session))
      emit(out, *report);
    else
      out << YAML::Null;
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void emitViews(YAML::Emitter& out, const std::vector<rgbd::View>& views, const std::vector<ViewOrigin>& origins)
{
  out << YAML::Key << "views" << YAML::Value << YAML::BeginSeq;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    const Eigen::Vector3d position_m = views[i].T_world_camera.translation();
    out << YAML::Flow << YAML::BeginMap;
    put(out, "index", i);
    out << YAML::Key << "session_id" << YAML::Value << YAML::DoubleQuoted << origins.at(i).session_id;
    put(out, "keyframe_id", origins[i].keyframe_id);
    out << YAML::Key << "camera_position_m" << YAML::Value << YAML::Flow << YAML::BeginSeq << position_m.x()
        << position_m.y() << position_m.z() << YAML::EndSeq << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void emitParameters(YAML::Emitter& out, const ModelOptions& options)
{
  begin(out, "parameters");
  put(out, "fusion/resolution_m", options.fusion.resolution_m);
  put(out, "fusion/averaging_radius_m", options.fusion.averaging_radius_m);
  put(out, "fusion/min_weight", options.fusion.min_weight);
  put(out, "fusion/consistency_sigmas", options.fusion.consistency_sigmas);
  put(out, "fusion/min_views", options.fusion.min_views);
  put(out, "fusion/weight/theta_max_rad", options.fusion.weight.theta_max_rad);
  put(out, "fusion/weight/sigma_lateral_m", options.fusion.weight.sigma_lateral_m);
  put(out, "surface/resolution_m", options.surface.resolution_m);
  put(out, "surface/max_support_distance_m", options.surface.max_support_distance_m);
  put(out, "surface/watertight", options.surface.watertight);
  put(out, "surface/max_triangles", options.surface.max_triangles);
  put(out, "surface/max_decimation_error_m", options.surface.max_decimation_error_m);
  put(out, "texture/texel_size_m", options.texture.texel_size_m);
  put(out, "texture/max_atlas_px", options.texture.max_atlas_px);
  put(out, "texture/view_preference", options.texture.view_preference);
  put(out, "texture/outlier_tolerance", options.texture.outlier_tolerance);
  out << YAML::EndMap;
}

void emitVersions(YAML::Emitter& out)
{
  begin(out, "versions");
  put(out, "object_modelling", OBJECT_MODELLING_VERSION);
  put(out, "opencv", CV_VERSION);
  put(out, "pcl", PCL_VERSION_PRETTY);
  put(out, "ceres", CERES_VERSION_STRING);
  put(out, "eigen",
      std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
          std::to_string(EIGEN_MINOR_VERSION));
  out << YAML::EndMap;
}

void emitIdentity(YAML::Emitter& out, const ModelIdentity& identity, int frame_version)
{
  begin(out, "frame");
  put(out, "version", frame_version);
  put(out, "by", identity.frame.by);
  put(out, "probability", identity.frame.probability);
  out << YAML::EndMap;
  out << YAML::Key << "looks_like" << YAML::Value << YAML::BeginSeq;
  for (const SimilarObject& similar : identity.looks_like)
  {
    out << YAML::Flow << YAML::BeginMap;
    out << YAML::Key << "id" << YAML::Value << YAML::DoubleQuoted << similar.object_id;
    put(out, "probability", similar.probability);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  out << YAML::Key << "warnings" << YAML::Value << YAML::BeginSeq;
  for (const std::string& warning : identity.warnings)
    if (!warning.empty())
      out << YAML::DoubleQuoted << warning;
  out << YAML::EndSeq;
}
}  // namespace

std::string qualityYaml(const database::ObjectModel& model, const std::vector<keyframes::Session>& sessions,
                        const std::vector<ViewOrigin>& origins, const ModelOptions& options,
                        const ModelIdentity& identity, const std::vector<StageTime>& stages)
{
  YAML::Emitter out;
  out.SetDoublePrecision(9);
  out << YAML::BeginMap;
  put(out, "schema_version", 1);
  begin(out, "figures");
  put(out, "view_count", model.views.size());
  out << YAML::Key << "size_m" << YAML::Value << YAML::Flow << YAML::BeginSeq << model.box_model.size_m.x()
      << model.box_model.size_m.y() << model.box_model.size_m.z() << YAML::EndSeq;
  put(out, "diameter_m", model.diameter_m);
  put(out, "point_count", model.cloud.size());
  put(out, "vertex_count", model.mesh.vertices.size());
  put(out, "triangle_count", model.mesh.triangles.size());
  const auto inconsistent = model.quality.find("inconsistent_observation_ratio");
  if (inconsistent != model.quality.end())
    put(out, inconsistent->first, inconsistent->second);
  out << YAML::EndMap;
  emitIdentity(out, identity, model.frame_version);
  emitSigma(out, model.cloud.sigmas_m);
  emitCoverage(out, coverageOf(model.mesh, model.views));
  emitSessions(out, sessions);
  emitViews(out, model.views, origins);
  begin(out, "stage_s");
  for (const StageTime& time : stages)
    put(out, time.stage, time.duration_s);
  out << YAML::EndMap;
  emitParameters(out, options);
  emitVersions(out);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace object_modelling::report
