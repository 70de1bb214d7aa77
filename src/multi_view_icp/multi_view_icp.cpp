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
  check.atLeast("max_iterations", max_iterations, 1);
  check.inRange("threads", threads, 1, 256);
  return check.violations();
}

MultiViewIcpResult refineByMultiViewIcp(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options,
                                        base::JobControl& control)
{
  base::checked(options);
  rgbd::checkPlaced(views);
  control.report("overlap", 0, views.size());
  IcpProblem problem(views, options, options.sessions_as_bodies ? std::vector<IcpEdge>() : overlapGraph(views, options),
                     &control);
  if (options.sessions_as_bodies)
    problem.add(linksBetweenBodies(views, problem.views(), options));
  const IcpOutcome outcome = runIcp(views, options, &problem, &control);
  return reportOf(views, options, problem, outcome);
}

}  // namespace object_modelling::multi_view_icp
