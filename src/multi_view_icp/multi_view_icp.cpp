#include "object_modelling/multi_view_icp/multi_view_icp.h"

#include "body_links.h"
#include "icp_report.h"
#include "object_modelling/base/options.h"

namespace object_modelling::multi_view_icp
{
std::vector<std::string> MultiViewIcpOptions::violations() const
{
  base::OptionsCheck check("multi_view_icp");
  check.inRange("start_error_m", start_error_m, 0.0, 0.2);
  check.inRange("points_per_keyframe", points_per_keyframe, 50, 100000);
  check.atLeast("max_partners", max_partners, 1);
  check.inRange("min_overlap_ratio", min_overlap_ratio, 0.01, 1.0);
  check.inRange("max_view_angle_rad", max_view_angle_rad, 0.05, 1.5);
  check.inRange("max_normal_angle_rad", max_normal_angle_rad, 0.05, 1.5);
  check.inRange("min_edge_distance_px", min_edge_distance_px, 0.0, 50.0);
  check.positive("loss_width_sigmas", loss_width_sigmas);
  check.inRange("color_weight", color_weight, 0.0, 1000.0);
  check.require("color_offset_px", color_offset_px.allFinite(), "must be finite");
  check.atLeast("max_iterations", max_iterations, 1);
  check.inRange("threads", threads, 1, 256);
  return check.violations();
}

MultiViewIcpResult refineByMultiViewIcp(const std::vector<rgbd::Keyframe>& keyframes,
                                        const MultiViewIcpOptions& options, base::JobControl& control)
{
  base::checked(options);
  if (!options.bodies.empty() && options.bodies.size() != keyframes.size())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "multi_view_icp: " + std::to_string(options.bodies.size()) +
                                                              " bodies of " + std::to_string(keyframes.size()) +
                                                              " keyframes; give one for each, or none");
  control.report("overlap", 0, keyframes.size());
  const bool by_keyframe = options.bodies.empty();
  IcpProblem problem(keyframes, options, by_keyframe ? overlapGraph(keyframes, options) : std::vector<IcpEdge>(),
                     &control);
  if (!by_keyframe)
    problem.add(linksBetweenBodies(keyframes, problem.views(), options));
  const IcpOutcome outcome = runIcp(keyframes, options, &problem, &control);
  return reportOf(keyframes, options, problem, outcome);
}

}  // namespace object_modelling::multi_view_icp
