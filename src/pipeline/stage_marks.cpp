#include "stage_marks.h"

#include <yaml-cpp/yaml.h>

#include "object_modelling/base/yaml_number.h"

namespace object_modelling::pipeline
{
namespace
{
template <typename Value>
void add(YAML::Emitter* out, const std::string& key, const Value& value)
{
  *out << YAML::Key << key << YAML::Value << value;
}

void add(YAML::Emitter* out, const std::string& key, double value)
{
  *out << YAML::Key << key << YAML::Value << base::yamlNumber(value);
}

void add(YAML::Emitter* out, const bundle_adjustment::BundleAdjustmentOptions& options)
{
  *out << YAML::Key << "bundle_adjustment" << YAML::Value << YAML::BeginMap;
  add(out, "pixel_sigma_px", options.pixel_sigma_px);
  add(out, "loss_width_sigmas", options.loss_width_sigmas);
  add(out, "link_keyframes", options.link_keyframes);
  add(out, "calibrate_color_offset", options.calibrate_color_offset);
  add(out, "calibrate_intrinsics", options.calibrate_intrinsics);
  add(out, "calibrate_depth_ratio", options.calibrate_depth_ratio);
  add(out, "calibrate_depth_offset", options.calibrate_depth_offset);
  add(out, "calibrate_depth_distortion", options.calibrate_depth_distortion);
  add(out, "object_only", options.object_only);
  add(out, "seed", options.seed);
  *out << YAML::EndMap;
}

void add(YAML::Emitter* out, const multi_view_icp::MultiViewIcpOptions& options)
{
  *out << YAML::Key << "multi_view_icp" << YAML::Value << YAML::BeginMap;
  add(out, "object_only", options.object_only);
  add(out, "start_error_m", options.start_error_m);
  add(out, "points_per_keyframe", options.points_per_keyframe);
  add(out, "max_partners", options.max_partners);
  add(out, "color_weight", options.color_weight);
  *out << YAML::EndMap;
}
}  // namespace

keyframes::StageMark refinementMark(const RefinementOptions& options, const SessionRefinement& refined)
{
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "method" << YAML::Value << nameOf(options.method);
  out << YAML::Key << "compared" << YAML::Value << YAML::BeginSeq;
  for (const ComparedPoses& poses : refined.compared)
  {
    out << YAML::Flow << YAML::BeginMap;
    out << YAML::Key << "by" << YAML::Value << poses.by;
    add(&out, "depth", poses.score.depth);
    add(&out, "gray", poses.score.gray);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  if (options.method != RefinementMethod::MULTI_VIEW_ICP)
    add(&out, options.bundle_adjustment);
  if (options.method != RefinementMethod::BUNDLE_ADJUSTMENT)
    add(&out, options.multi_view_icp);
  out << YAML::EndMap;
  return { refined.chosen, out.c_str() };
}

keyframes::StageMark segmentationMark(const std::optional<Eigen::Vector3d>& seed_point_session,
                                      const segmentation::ObjectMaskPropagatorOptions& options)
{
  YAML::Emitter out;
  out << YAML::BeginMap;
  if (seed_point_session)
    out << YAML::Key << "seed_point_session_m" << YAML::Value << YAML::Flow
        << std::vector<double>(seed_point_session->data(), seed_point_session->data() + 3);
  add(&out, "voxel_size_m", options.voxel_size_m);
  add(&out, "min_cluster_overlap_ratio", options.min_cluster_overlap_ratio);
  out << YAML::EndMap;
  return { seed_point_session ? keyframes::stage_mark::BY_HAND : keyframes::stage_mark::AUTOMATIC, out.c_str() };
}

}  // namespace object_modelling::pipeline
