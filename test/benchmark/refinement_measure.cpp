#include "refinement_measure.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "object_modelling/rgbd/keyframe_view.h"
#include "tracking_metrics.h"

namespace object_modelling::benchmark_refinement
{
namespace
{
constexpr double DEGREES = 180 / M_PI;

/// Where the middle of a view meets the scene, in the camera frame.
Eigen::Vector3d middleOf(const rgbd::Frame& frame)
{
  std::vector<float> depths_m;
  const int u = frame.depth_m.cols / 2, v = frame.depth_m.rows / 2;
  for (int dv = -20; dv <= 20; ++dv)
    for (int du = -20; du <= 20; ++du)
      if (frame.depthAt_m(u + du, v + dv) > 0)
        depths_m.push_back(frame.depthAt_m(u + du, v + dv));
  if (depths_m.empty())
    return { 0, 0, 0 };
  std::nth_element(depths_m.begin(), depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2),
                   depths_m.end());
  return frame.camera.unproject(u, v, depths_m[depths_m.size() / 2]);
}

base::Status runStep(const std::string& step, const MeasureOptions& options, std::vector<rgbd::Keyframe>* keyframes,
                     Eigen::Vector2d* color_offset_px, Measurement* measurement)
{
  base::JobControl control;
  std::vector<Eigen::Isometry3d> refined;
  base::Status status;
  if (step == "ba")
  {
    bundle_adjustment::BundleAdjustmentOptions bundle;
    bundle.object_only = options.object_only;
    bundle.threads = options.threads;
    bundle.seed = options.seed;
    const bundle_adjustment::BundleAdjustmentResult result =
        bundle_adjustment::adjustBundle(*keyframes, bundle, control);
    measurement->pairs = result.links.size();
    measurement->left_out = result.left_out.size();
    measurement->iterations += result.iterations;
    *color_offset_px = result.color_offset_px;
    refined = result.T_session_camera;
    status = result.status;
  }
  else
  {
    multi_view_icp::MultiViewIcpOptions icp = options.icp;
    icp.object_only = options.object_only;
    icp.threads = options.threads;
    const multi_view_icp::MultiViewIcpResult result =
        multi_view_icp::refineByMultiViewIcp(rgbd::viewsOf(*keyframes, *color_offset_px), icp, control);
    measurement->pairs = result.pairs.size();
    measurement->left_out = result.left_out.size();
    measurement->free_directions = result.free_directions.size();
    measurement->iterations += result.iterations;
    for (const double rmse_m : result.rmse_m)
      measurement->rmse_mm.push_back(1e3 * rmse_m);
    refined = result.T_world_camera;
    status = result.status;
  }
  for (std::size_t k = 0; k < refined.size(); ++k)
    (*keyframes)[k].T_session_camera = refined[k];
  return status;
}
}  // namespace

Measurement measure(const std::string& method, std::vector<rgbd::Keyframe> keyframes,
                    const std::vector<source::StampedPose>& truth, const MeasureOptions& options)
{
  std::vector<std::string> steps;
  std::istringstream names(method);
  for (std::string step; std::getline(names, step, '+');)
  {
    if (step != "ba" && step != "icp")
      throw base::Error(base::StatusCode::INVALID_ARGUMENT, "method '" + method + "': steps are 'ba' and 'icp'");
    steps.push_back(step);
  }
  Measurement measurement;
  measurement.method = method;
  measurement.keyframes = keyframes.size();
  std::vector<Eigen::Isometry3d> poses;
  for (const rgbd::Keyframe& keyframe : keyframes)
    poses.push_back(keyframe.T_session_camera);
  measurement.before = poseErrors(keyframes, poses, truth);
  benchmark_tracking::resetPeakMemory();
  const double wall_ms = benchmark_tracking::wallTime_ms(), cpu_ms = benchmark_tracking::cpuTime_ms();
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
  for (const std::string& step : steps)
  {
    const base::Status status = runStep(step, options, &keyframes, &color_offset_px, &measurement);
    if (!status.ok())
      measurement.problem = step + ": " + status.message;
  }
  measurement.wall_s = 1e-3 * (benchmark_tracking::wallTime_ms() - wall_ms);
  measurement.cpu_s = 1e-3 * (benchmark_tracking::cpuTime_ms() - cpu_ms);
  measurement.peak_mb = benchmark_tracking::peakMemory_mb();
  for (const rgbd::Keyframe& keyframe : keyframes)
    measurement.T_session_camera.push_back(keyframe.T_session_camera);
  measurement.after = poseErrors(keyframes, measurement.T_session_camera, truth);
  return measurement;
}

std::vector<rgbd::Keyframe> evenlyChosen(const std::vector<rgbd::Keyframe>& keyframes, std::size_t count)
{
  std::vector<rgbd::Keyframe> chosen;
  for (std::size_t i = 0; i < std::min(count, keyframes.size()); ++i)
  {
    chosen.push_back(keyframes[i * keyframes.size() / std::min(count, keyframes.size())]);
    chosen.back().id = static_cast<int>(i);
  }
  return chosen;
}

void disturb(double translation_m, double rotation_rad, std::uint64_t seed, std::vector<rgbd::Keyframe>* keyframes)
{
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1 / std::sqrt(3.0));
  for (std::size_t k = 1; k < keyframes->size(); ++k)
  {
    geometry::Vector6d motion;
    for (int i = 0; i < 6; ++i)
      motion[i] = normal(random) * (i < 3 ? translation_m : rotation_rad);
    (*keyframes)[k].T_session_camera = (*keyframes)[k].T_session_camera * geometry::isometryFromVector(motion);
  }
}

std::optional<PoseErrors> poseErrors(const std::vector<rgbd::Keyframe>& keyframes,
                                     const std::vector<Eigen::Isometry3d>& T_session_camera,
                                     const std::vector<source::StampedPose>& truth)
{
  std::vector<source::StampedPose> estimate;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    estimate.push_back({ keyframes[k].frame.stamp_s, T_session_camera[k] });
  const auto score = benchmark_tracking::scoreTrajectory(estimate, truth, {}, {});
  if (!score || score->pairs.size() != keyframes.size())
    return std::nullopt;
  std::vector<double> misplaced_mm, rotations_deg;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
  {
    const auto& pair = score->pairs[k];
    const Eigen::Vector3d p = middleOf(keyframes[k].frame);
    misplaced_mm.push_back(1e3 * (pair.T_world_camera * p - pair.truth * p).norm());
    rotations_deg.push_back(DEGREES * geometry::rotationAngle_rad(pair.truth.inverse() * pair.T_world_camera));
  }
  const auto rotation = benchmark_tracking::statisticsOf(rotations_deg);
  return PoseErrors{ score->ate_mm.rmse, score->ate_mm.max, rotation.rmse, rotation.max,
                     benchmark_tracking::statisticsOf(misplaced_mm).rmse };
}

}  // namespace object_modelling::benchmark_refinement
