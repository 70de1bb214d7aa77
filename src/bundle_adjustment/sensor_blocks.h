#pragma once

#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <Eigen/Core>

#include "bundle_solver.h"
#include "cost_functions.h"

namespace object_modelling::bundle_adjustment
{
/// The parameter blocks that all keyframes share, as ReprojectionCost and DepthCost take them.
struct SensorBlocks
{
  Eigen::Vector2d color_offset_px;
  Eigen::Vector4d intrinsics;  ///< share that fx, fy grow by; shift of cx, cy in px
  double depth_growth = 0;     ///< share that depth grows by
  double depth_offset_m = 0;
  rgbd::DistortionGrid::Ratios distortion_ratio{};

  explicit SensorBlocks(const BundleState& state);
  void addDepthCost(std::unique_ptr<DepthCost> cost, const Eigen::Vector2d& pixel,
                    const geometry::PinholeCamera& camera, const BundleSolverOptions& options,
                    ceres::LossFunction* loss, double* motion, double* landmark, ceres::Problem* problem);
  /// Priors for what is calibrated, the rest held constant. Once all residuals have been added.
  void finish(const BundleSolverOptions& options, ceres::Problem* problem, ceres::ParameterBlockOrdering* ordering);
  /// With sigmas, where the sensor was calibrated; NaN where they could not be computed.
  void store(const BundleSolverOptions& options, ceres::Problem* problem, BundleState* state) const;
};

}  // namespace object_modelling::bundle_adjustment
