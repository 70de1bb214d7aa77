#pragma once

#include <Eigen/Core>

#include "object_modelling/rgbd/distortion_grid.h"

namespace object_modelling::rgbd
{
/// Systematic error of a sensor, the same for all its frames. The sigmas are 0 where nothing was estimated; sigmas as
/// large as the prior's mean that the recording did not determine the value.
struct SensorCorrection
{
  Eigen::Vector2d focal_ratio{ 1, 1 };         ///< true fx, fy over those given
  Eigen::Vector2d principal_shift_px{ 0, 0 };  ///< true cx, cy minus those given
  double depth_ratio = 1;                      ///< true depth = depth_ratio * measured + depth_offset_m
  double depth_offset_m = 0;
  /// Measured depth times this is taken off the depth first. 0 on the mean of all knots: the rest is depth_ratio.
  DistortionGrid::Ratios depth_distortion_ratio{};
  Eigen::Vector2d focal_ratio_sigma{ 0, 0 };  ///< of fx, fy
  Eigen::Vector2d principal_shift_sigma_px{ 0, 0 };
  double depth_ratio_sigma = 0;
  double depth_offset_sigma_m = 0;
  DistortionGrid::Ratios depth_distortion_sigma_ratio{};

  bool isIdentity() const;
  /// Of a sensor whose frames, corrected by this, turned out to be off by `rest` too; sigmas are those of `rest`.
  SensorCorrection then(const SensorCorrection& rest) const;
  bool operator==(const SensorCorrection& other) const;
};

}  // namespace object_modelling::rgbd
