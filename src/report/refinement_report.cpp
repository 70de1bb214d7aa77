#include "object_modelling/report/refinement_report.h"

#include "object_modelling/base/status.h"
#include "refinement_yaml.h"

namespace object_modelling::report
{
namespace
{
/// Calls visit(name, field) for each field but the residuals, in the order of files.
template <typename Visit, typename Report>
void forFields(const Visit& visit, Report& report)
{
  visit("iterations", report.iterations);
  visit("initial_cost", report.initial_cost);
  visit("final_cost", report.final_cost);
  visit("color_offset_px", report.color_offset_px);
  visit("link_count", report.link_count);
  visit("rejected_link_count", report.rejected_link_count);
  visit("left_out", report.left_out);
}

struct Write
{
  YAML::Emitter& out;

  template <typename Value>
  void operator()(const char* name, const Value& value) const
  {
    out << YAML::Key << name << YAML::Value << value;
  }
  void operator()(const char* name, const Eigen::Vector2d& v) const
  {
    out << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginSeq << v.x() << v.y() << YAML::EndSeq;
  }
  void operator()(const char* name, const std::vector<int>& ids) const
  {
    out << YAML::Key << name << YAML::Value << YAML::Flow << ids;
  }
};

struct Read
{
  const YAML::Node& node;

  template <typename Value>
  void operator()(const char* name, Value& value) const
  {
    value = node[name].as<Value>();
  }
  void operator()(const char* name, Eigen::Vector2d& v) const
  {
    v = { node[name][0].as<double>(), node[name][1].as<double>() };
  }
};

RefinementReport reportOf(const bundle_adjustment::BundleAdjustmentResult& result)
{
  RefinementReport report;
  report.iterations = result.iterations;
  report.initial_cost = result.initial_cost;
  report.final_cost = result.final_cost;
  report.color_offset_px = result.color_offset_px;
  report.link_count = static_cast<int>(result.links.size());
  report.rejected_link_count = static_cast<int>(result.rejected_links.size());
  report.left_out = result.left_out;
  report.residuals = result.residuals;
  return report;
}
}  // namespace

void emit(YAML::Emitter& out, const RefinementReport& report)
{
  out << YAML::BeginMap;
  forFields(Write{ out }, report);
  out << YAML::Key << "keyframes" << YAML::Value << YAML::BeginSeq;
  for (const bundle_adjustment::KeyframeResidual& residual : report.residuals)
  {
    out << YAML::Flow << YAML::BeginMap;
    bundle_adjustment::forFields(Write{ out }, residual);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
}

std::string refinementReportYaml(const bundle_adjustment::BundleAdjustmentResult& result)
{
  YAML::Emitter out;
  emit(out, reportOf(result));
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
    forFields(Read{ node }, report);
    for (const YAML::Node& keyframe : node["keyframes"])
      bundle_adjustment::forFields(Read{ keyframe }, report.residuals.emplace_back());
  }
  catch (const YAML::Exception& error)
  {
    throw base::Error(base::StatusCode::BAD_INPUT,
                      std::string("the refinement report of a session cannot be read: ") + error.what());
  }
  return report;
}

}  // namespace object_modelling::report
