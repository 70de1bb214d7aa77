#pragma once

#include <vector>

#include "icp_problem.h"

namespace object_modelling::multi_view_icp
{
/// How far the view that moved most moved what it sees, and how far that which turned most turned.
struct IcpStep
{
  double moved_m = 0, turned_rad = 0;
};

/// What multi-view ICP found, before it is put into a report.
struct IcpOutcome
{
  std::vector<Eigen::Isometry3d> T_world_camera;
  std::vector<int> members;  ///< views that took part; the first stayed where it was; empty if none fit
  std::vector<double> rmse_m;
  IcpStep last_step;
  bool converged = false;
};

/// Matches and solves by turns, from the widest gate to noise alone; leaves out views that then do not fit, and
/// solves again. Bodies that have not converged are left at their least error. Leaves `problem` matched at the outcome.
IcpOutcome runIcp(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options, IcpProblem* problem,
                  base::JobControl* control);

}  // namespace object_modelling::multi_view_icp
