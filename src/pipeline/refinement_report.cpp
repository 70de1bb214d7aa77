#include "refinement_report.h"

#include <yaml-cpp/yaml.h>

#include "object_modelling/base/status.h"

namespace object_modelling::pipeline
{
std::string refinementReportYaml(const bundle_adjustment::BundleAdjustmentResult& result)
{
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "iterations" << YAML::Value << result.iterations;
  out << YAML::Key << "initial_cost" << YAML::Value << result.initial_cost;
  out << YAML::Key << "final_cost" << YAML::Value << result.final_cost;
  out << YAML::Key << "color_offset_px" << YAML::Value << YAML::Flow << YAML::BeginSeq << result.color_offset_px.x()
      << result.color_offset_px.y() << YAML::EndSeq;
  out << YAML::Key << "link_count" << YAML::Value << result.links.size();
  out << YAML::Key << "rejected_link_count" << YAML::Value << result.rejected_links.size();
  out << YAML::Key << "left_out" << YAML::Value << YAML::Flow << result.left_out;
  out << YAML::Key << "keyframes" << YAML::Value << YAML::BeginSeq;
  for (const bundle_adjustment::KeyframeResidual& residual : result.residuals)
  {
    out << YAML::Flow << YAML::BeginMap;
    out << YAML::Key << "keyframe_id" << YAML::Value << residual.keyframe_id;
    out << YAML::Key << "observation_count" << YAML::Value << residual.observation_count;
    out << YAML::Key << "reprojection_rmse_before_px" << YAML::Value << residual.reprojection_rmse_before_px;
    out << YAML::Key << "reprojection_rmse_after_px" << YAML::Value << residual.reprojection_rmse_after_px;
    out << YAML::Key << "depth_rmse_before_m" << YAML::Value << residual.depth_rmse_before_m;
    out << YAML::Key << "depth_rmse_after_m" << YAML::Value << residual.depth_rmse_after_m << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

std::optional<RefinementReport> readRefinementReport(const std::string& yaml)
{
  if (yaml.empty())
    return std::nullopt;
  RefinementReport report;
  try
  {
    const YAML::Node node = YAML::Load(yaml);
    report.iterations = node["iterations"].as<int>();
    report.initial_cost = node["initial_cost"].as<double>();
    report.final_cost = node["final_cost"].as<double>();
    report.color_offset_px = { node["color_offset_px"][0].as<double>(), node["color_offset_px"][1].as<double>() };
    report.link_count = node["link_count"].as<int>();
    report.rejected_link_count = node["rejected_link_count"].as<int>();
    report.left_out = node["left_out"].as<std::vector<int>>();
    for (const YAML::Node& keyframe : node["keyframes"])
    {
      bundle_adjustment::KeyframeResidual residual;
      residual.keyframe_id = keyframe["keyframe_id"].as<int>();
      residual.observation_count = keyframe["observation_count"].as<int>();
      residual.reprojection_rmse_before_px = keyframe["reprojection_rmse_before_px"].as<double>();
      residual.reprojection_rmse_after_px = keyframe["reprojection_rmse_after_px"].as<double>();
      residual.depth_rmse_before_m = keyframe["depth_rmse_before_m"].as<double>();
      residual.depth_rmse_after_m = keyframe["depth_rmse_after_m"].as<double>();
      report.residuals.push_back(residual);
    }
  }
  catch (const YAML::Exception& error)
  {
    throw base::Error(base::StatusCode::BAD_INPUT,
                      std::string("the refinement report of a session cannot be read: ") + error.what());
  }
  return report;
}

}  // namespace object_modelling::pipeline
