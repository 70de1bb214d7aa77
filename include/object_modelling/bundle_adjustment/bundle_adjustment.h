#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/rgbd/sensor_correction.h"

namespace object_modelling::bundle_adjustment
{
struct BundleAdjustmentOptions
{
  double pixel_sigma_px = 0.5;            ///< of an observation; > 0
  double loss_width_sigmas = 2.0;         ///< > 0; residuals beyond count robustly (Cauchy)
  int min_observations_per_landmark = 2;  ///< >= 2; landmarks with fewer take no part
  int max_iterations = 300;               ///< >= 1
  bool link_keyframes = true;             ///< match keyframes that the tracker did not link before adjusting
  /// Find by how much the colour images are shifted against the depth images, which are seldom registered to the pixel.
  /// Where surfaces are steep a shift of a third of a pixel makes the whole model 0.1 % too small.
  bool calibrate_color_offset = true;
  /// Find what the intrinsics and the depth are off by, first of all, from landmarks; the rest is then done on frames
  /// corrected by it. The ratio of depth is the scale of everything, which no recording determines: it stays within
  /// its prior, and its sigma is that of the prior.
  bool calibrate_intrinsics = false;
  bool calibrate_depth_ratio = false;
  bool calibrate_depth_offset = false;
  bool calibrate_depth_distortion = false;  ///< determined by wide scenes with texture; plain ones bend
  bool object_only = false;                 ///< only observations on the object mask (turntable, object in motion)
  bool calibratesSensor() const
  {
    return calibrate_intrinsics || calibrate_depth_ratio || calibrate_depth_offset || calibrate_depth_distortion;
  }
  int threads = 1;  ///< more than one: results are no longer equal bit for bit
  std::uint64_t seed = 1;
  std::vector<std::string> violations() const;
};

/// Over the observations that end up as inliers (within 6 sigmas), the same ones before and after.
struct KeyframeResidual
{
  int keyframe_id = -1;
  int observation_count = 0;
  double reprojection_rmse_before_px = 0, reprojection_rmse_after_px = 0;
  double depth_rmse_before_m = 0, depth_rmse_after_m = 0;
};

/// Calls visit(name, field...) for each field of a residual, in the order of files. Of several, messages too, with the
/// field of each.
template <typename Visit, typename... Residuals>
void forFields(const Visit& visit, Residuals&... residuals)
{
  visit("keyframe_id", residuals.keyframe_id...);
  visit("observation_count", residuals.observation_count...);
  visit("reprojection_rmse_before_px", residuals.reprojection_rmse_before_px...);
  visit("reprojection_rmse_after_px", residuals.reprojection_rmse_after_px...);
  visit("depth_rmse_before_m", residuals.depth_rmse_before_m...);
  visit("depth_rmse_after_m", residuals.depth_rmse_after_m...);
}

/// Two keyframes linked by a direct, geometrically verified match: an independent measurement of their relative pose.
struct KeyframeLink
{
  int keyframe_a = -1, keyframe_b = -1;                     ///< ids
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< from the match alone
  int inlier_count = 0;
  double translation_error_before_m = 0, translation_error_after_m = 0;  ///< poses against T_a_b
  double rotation_error_before_rad = 0, rotation_error_after_rad = 0;
};

struct BundleAdjustmentResult
{
  base::Status status;  ///< NO_RESULT: not converged or nothing to adjust; poses are then those that came in
  std::vector<Eigen::Isometry3d> T_session_camera;  ///< per keyframe, in the order given
  std::vector<geometry::Matrix6d> covariance;       ///< likewise, of T_session_camera
  std::vector<KeyframeResidual> residuals;          ///< likewise
  std::vector<KeyframeLink> links;  ///< verified pairs that the tracker had not linked; loop closures among them
  std::vector<KeyframeLink> rejected_links;  ///< geometrically verified too, but in contradiction to the rest; not used
  std::vector<int> left_out;                 ///< ids of keyframes that nothing links to the others; poses unchanged
  /// Pixel of a point in the colour image minus its pixel in the depth image, whose camera the poses are of. Zero
  /// unless calibrated.
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
  /// Of the frames given: poses, residuals and covariance are those of frames corrected by it. Identity unless
  /// calibrated.
  rgbd::SensorCorrection sensor;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;  ///< Cauchy losses of pixels and depths, summed
};

/// Joint refinement of keyframe poses and landmarks (Ceres): reprojection and depth residuals with the sigma of the
/// noise model, robust loss on each, first pose fixed. Deterministic for threads = 1.
BundleAdjustmentResult adjustBundle(const std::vector<rgbd::Keyframe>& keyframes,
                                    const BundleAdjustmentOptions& options, base::JobControl& control);

}  // namespace object_modelling::bundle_adjustment
