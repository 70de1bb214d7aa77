#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/bundle_adjustment/bundle_adjustment.h"
#include "object_modelling/multi_view_icp/multi_view_icp.h"
#include "tracking_run.h"

namespace object_modelling::benchmark_refinement
{
/// Errors of keyframe poses after rigid alignment with the truth.
struct PoseErrors
{
  double ate_rmse_mm = 0, ate_max_mm = 0;
  double rotation_rmse_deg = 0, rotation_max_deg = 0;
  double view_rmse_mm = 0;  ///< by which the point in the middle of each view is misplaced
};

struct MeasureOptions
{
  bool object_only = false;
  int threads = 2;
  std::uint64_t seed = 1;
  multi_view_icp::MultiViewIcpOptions icp;
};

/// Result and cost of one way to refine.
struct Measurement
{
  std::string method;
  std::size_t keyframes = 0, pairs = 0, left_out = 0, free_directions = 0;
  int iterations = 0;
  double wall_s = 0, cpu_s = 0, peak_mb = 0;  ///< of the process, the keyframes' images among it
  std::string problem;                        ///< why there is no result; empty when there is one
  std::vector<double> rmse_mm;                ///< of multi-view ICP, by iteration
  std::optional<PoseErrors> before, after;    ///< where there is a truth
  std::vector<Eigen::Isometry3d> T_session_camera;
};

/// `method`: steps in order, joined by '+': "ba" (bundle adjustment), "icp". Throws base::Error for others.
Measurement measure(const std::string& method, std::vector<rgbd::Keyframe> keyframes,
                    const std::vector<source::StampedPose>& truth, const MeasureOptions& options);

/// `count` of the keyframes, evenly; ids count from 0 anew.
std::vector<rgbd::Keyframe> evenlyChosen(const std::vector<rgbd::Keyframe>& keyframes, std::size_t count);

/// Every pose but the first moved at random about its own camera: RMS of the displacement and of the angle.
void disturb(double translation_m, double rotation_rad, std::uint64_t seed, std::vector<rgbd::Keyframe>* keyframes);

std::optional<PoseErrors> poseErrors(const std::vector<rgbd::Keyframe>& keyframes,
                                     const std::vector<Eigen::Isometry3d>& T_session_camera,
                                     const std::vector<source::StampedPose>& truth);

}  // namespace object_modelling::benchmark_refinement
