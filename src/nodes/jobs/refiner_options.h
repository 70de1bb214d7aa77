#pragma once

#include <string>
#include <vector>

#include "../common/store_parameters.h"
#include "object_modelling/base/options.h"
#include "object_modelling/pipeline/session_refinement.h"

namespace object_modelling::nodes
{
struct RefinerOptions
{
  std::string method = "both";  ///< bundle_adjustment, multi_view_icp or both, where a goal names none
  pipeline::RefinementOptions refinement;
  ros_bridge::RemoteSessionStoreOptions store;

  std::vector<std::string> violations() const
  {
    base::OptionsCheck check("refiner");
    check.require("method", method == "bundle_adjustment" || method == "multi_view_icp" || method == "both",
                  "must be bundle_adjustment, multi_view_icp or both");
    check.include(refinement.violations());
    return check.violations();
  }
};

template <typename Reader>
void read(Reader& reader, RefinerOptions* options)
{
  bundle_adjustment::BundleAdjustmentOptions& adjustment = options->refinement.bundle_adjustment;
  reader.read("method", options->method);
  reader.read("bundle_adjustment/pixel_sigma_px", adjustment.pixel_sigma_px);
  reader.read("bundle_adjustment/loss_width_sigmas", adjustment.loss_width_sigmas);
  reader.read("bundle_adjustment/min_observations_per_landmark", adjustment.min_observations_per_landmark);
  reader.read("bundle_adjustment/max_iterations", adjustment.max_iterations);
  reader.read("bundle_adjustment/link_keyframes", adjustment.link_keyframes);
  reader.read("bundle_adjustment/calibrate_color_offset", adjustment.calibrate_color_offset);
  reader.read("bundle_adjustment/calibrate_intrinsics", adjustment.calibrate_intrinsics);
  reader.read("bundle_adjustment/calibrate_depth_ratio", adjustment.calibrate_depth_ratio);
  reader.read("bundle_adjustment/calibrate_depth_offset", adjustment.calibrate_depth_offset);
  reader.read("bundle_adjustment/calibrate_depth_distortion", adjustment.calibrate_depth_distortion);
  reader.read("bundle_adjustment/object_only", adjustment.object_only);
  reader.read("bundle_adjustment/threads", adjustment.threads);
  reader.read("bundle_adjustment/seed", adjustment.seed);
  multi_view_icp::MultiViewIcpOptions& icp = options->refinement.multi_view_icp;
  reader.read("multi_view_icp/object_only", icp.object_only);
  reader.read("multi_view_icp/start_error_m", icp.start_error_m);
  reader.read("multi_view_icp/points_per_keyframe", icp.points_per_keyframe);
  reader.read("multi_view_icp/max_partners", icp.max_partners);
  reader.read("multi_view_icp/min_overlap_ratio", icp.min_overlap_ratio);
  reader.read("multi_view_icp/max_view_angle_rad", icp.max_view_angle_rad);
  reader.read("multi_view_icp/max_normal_angle_rad", icp.max_normal_angle_rad);
  reader.read("multi_view_icp/min_edge_distance_px", icp.min_edge_distance_px);
  reader.read("multi_view_icp/loss_width_sigmas", icp.loss_width_sigmas);
  reader.read("multi_view_icp/color_weight", icp.color_weight);
  reader.read("multi_view_icp/max_iterations", icp.max_iterations);
  reader.read("multi_view_icp/threads", icp.threads);
  read(reader, &options->store);
}

}  // namespace object_modelling::nodes
