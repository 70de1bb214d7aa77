#pragma once

#include <vector>

#include "landmark_map.h"
#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/sensor_correction.h"
#include "surface_links.h"

namespace object_modelling::bundle_adjustment
{
struct BundleSolverOptions
{
  double loss_width_sigmas = 2;
  double min_improvement_ratio = 1e-6;  ///< of the cost in one iteration; less ends it
  int max_iterations = 50;
  int threads = 1;
  bool calibrate_color_offset = false;  ///< this and the following: else it stays as it is in the state
  bool calibrate_intrinsics = false;
  bool calibrate_depth_ratio = false;
  bool calibrate_depth_offset = false;
  bool calibrate_depth_distortion = false;

  bool calibratesSensor() const
  {
    return calibrate_intrinsics || calibrate_depth_ratio || calibrate_depth_offset || calibrate_depth_distortion;
  }
};

struct BundleSolverSummary
{
  bool usable = false;
  bool converged = false;
  int iterations = 0;
};

/// Poses and landmarks that belong together.
struct BundleState
{
  std::vector<Eigen::Isometry3d> T_session_camera;
  LandmarkMap map;
  std::vector<SurfaceLink> surface_links;
  /// Pixel of a point in the colour image minus its pixel in the depth image.
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
  /// Its sigmas are set by a run that calibrates the sensor.
  rgbd::SensorCorrection sensor;
};

/// One run of Levenberg-Marquardt over all poses and landmarks (Ceres, landmarks eliminated first), Cauchy loss on
/// every pixel and every depth on its own, so that a bad depth does not cost a good pixel; with them, if asked for, the
/// offset of the colour images and what the sensor is off by. `fixed_keyframe` stays where
/// it is. `state` is changed only if the summary is usable. Rethrows what `control` throws.
BundleSolverSummary solveBundle(const std::vector<rgbd::Keyframe>& keyframes, int fixed_keyframe,
                                const BundleSolverOptions& options, base::JobControl& control, BundleState* state);

/// Pixel error (px) and depth error (m, NaN where no depth) of a sight. The pixel error of a landmark behind the camera
/// is infinite.
struct SightError
{
  double pixel_px = 0;
  double depth_m = 0;
};
SightError sightError(const Sight& sight, const geometry::PinholeCamera& camera, const BundleState& state);

/// Half the sum of all Cauchy losses, as the solver counts them.
double robustCost(const std::vector<rgbd::Keyframe>& keyframes, double loss_width_sigmas, const BundleState& state);

}  // namespace object_modelling::bundle_adjustment
