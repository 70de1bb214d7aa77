#include "adjustment_report.h"

#include <algorithm>
#include <cmath>

#include <glog/logging.h>

#include "pose_covariance.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
class WeightedMeanSquare
{
public:
  void add(double value, double weight)
  {
    sum_ += weight * value * value;
    weight_ += weight;
  }
  double root() const { return weight_ > 0 ? std::sqrt(sum_ / weight_) : 0; }

private:
  double sum_ = 0;
  double weight_ = 0;
};

/// Coarse features count less, in proportion to their precision.
void reportResiduals(const std::vector<rgbd::Keyframe>& keyframes, const BundleState& before, const BundleState& after,
                     BundleAdjustmentResult* result)
{
  std::vector<WeightedMeanSquare> pixel_before(keyframes.size()), pixel_after(keyframes.size());
  std::vector<WeightedMeanSquare> depth_before(keyframes.size()), depth_after(keyframes.size());
  for (const Sight& sight : after.map.sights)
  {
    const int k = sight.keyframe;
    const SightError error_before = sightError(sight, keyframes[k].frame.camera, before);
    const SightError error_after = sightError(sight, keyframes[k].frame.camera, after);
    if (!std::isfinite(error_before.pixel_px) || !std::isfinite(error_after.pixel_px))
      continue;
    ++result->residuals[k].observation_count;
    const double weight = 1 / (sight.sigma_px * sight.sigma_px);
    pixel_before[k].add(error_before.pixel_px, weight);
    pixel_after[k].add(error_after.pixel_px, weight);
    const double depth_gate_m =
        OUTLIER_SIGMAS * keyframes[k].frame.noise_model.axialSigma_m(std::max(sight.depth_m, 0.0), 0);
    if (!(sight.depth_m > 0) || !(std::abs(error_after.depth_m) <= depth_gate_m))
      continue;
    depth_before[k].add(error_before.depth_m, weight);
    depth_after[k].add(error_after.depth_m, weight);
  }
  for (std::size_t k = 0; k < keyframes.size(); ++k)
  {
    KeyframeResidual& residual = result->residuals[k];
    residual.reprojection_rmse_before_px = pixel_before[k].root();
    residual.reprojection_rmse_after_px = pixel_after[k].root();
    residual.depth_rmse_before_m = depth_before[k].root();
    residual.depth_rmse_after_m = depth_after[k].root();
  }
}

void reportLinks(const std::vector<rgbd::Keyframe>& keyframes, const Adjustment& adjustment,
                 BundleAdjustmentResult* result)
{
  for (std::size_t i = 0; i < adjustment.links.size(); ++i)
  {
    const VerifiedLink& link = adjustment.links[i];
    const auto difference = [&](const std::vector<Eigen::Isometry3d>& poses)
    { return link.T_a_b.inverse() * (poses[link.a].inverse() * poses[link.b]); };
    const Eigen::Isometry3d before = difference(adjustment.T_session_camera_start);
    const Eigen::Isometry3d after = difference(result->T_session_camera);
    KeyframeLink reported;
    reported.keyframe_a = keyframes[link.a].id;
    reported.keyframe_b = keyframes[link.b].id;
    reported.T_a_b = link.T_a_b;
    reported.inlier_count = static_cast<int>(link.points.size());
    reported.translation_error_before_m = before.translation().norm();
    reported.translation_error_after_m = after.translation().norm();
    reported.rotation_error_before_rad = geometry::rotationAngle_rad(before);
    reported.rotation_error_after_rad = geometry::rotationAngle_rad(after);
    (adjustment.active[i] ? result->links : result->rejected_links).push_back(reported);
  }
  if (!result->rejected_links.empty())
    LOG(INFO) << result->rejected_links.size() << " of " << adjustment.links.size()
              << " keyframe links contradict the rest";
}
}  // namespace

BundleAdjustmentResult reportOf(const std::vector<rgbd::Keyframe>& keyframes, const BundleAdjustmentOptions& options,
                                const Adjustment& adjustment)
{
  BundleAdjustmentResult result;
  result.T_session_camera = adjustment.T_session_camera_start;
  for (const rgbd::Keyframe& keyframe : keyframes)
  {
    result.covariance.push_back(keyframe.covariance);
    result.residuals.emplace_back();
    result.residuals.back().keyframe_id = keyframe.id;
  }
  const bool possible = adjustment.summary.usable;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    if (!possible || !std::binary_search(adjustment.members.begin(), adjustment.members.end(), static_cast<int>(k)))
      result.left_out.push_back(keyframes[k].id);
  if (!possible)
  {
    result.status = { base::StatusCode::NO_RESULT,
                      "nothing to adjust: no two of " + std::to_string(keyframes.size()) + " keyframes share " +
                          std::to_string(MIN_SHARED) +
                          " landmarks or could be matched; record more slowly or with more texture in view" };
    if (keyframes.size() == 1)
      result.left_out.clear();
    return result;
  }
  result.iterations = adjustment.iterations;
  BundleState before{ adjustment.T_session_camera_start, adjustment.state.map, {}, Eigen::Vector2d::Zero(), {} };
  replaceLandmarks(keyframes, adjustment.T_session_camera_start, &before.map);
  result.initial_cost = robustCost(keyframes, options.loss_width_sigmas, before);
  result.final_cost = robustCost(keyframes, options.loss_width_sigmas, adjustment.state);
  if (!adjustment.summary.converged)
  {
    result.status = { base::StatusCode::NO_RESULT, "bundle adjustment did not converge within " +
                                                       std::to_string(options.max_iterations) +
                                                       " iterations; raise max_iterations" };
    return result;
  }
  result.T_session_camera = adjustment.state.T_session_camera;
  result.color_offset_px = adjustment.state.color_offset_px;
  result.sensor = adjustment.state.sensor;
  reportResiduals(keyframes, before, adjustment.state, &result);
  reportLinks(keyframes, adjustment, &result);
  const std::vector<geometry::Matrix6d> covariance =
      poseCovariances(keyframes, adjustment.members.front(), options.loss_width_sigmas, adjustment.state);
  // What surfaces alone constrain has none here, and keeps what it came with: zero would mean that nothing is unsure.
  for (int k : adjustment.members)
    if (k == adjustment.members.front() || !covariance[k].isZero(0))
      result.covariance[k] = covariance[k];
  return result;
}

}  // namespace object_modelling::bundle_adjustment
