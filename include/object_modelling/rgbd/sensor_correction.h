#pragma once

#include <Eigen/Core>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
/// What a sensor is off by, for all its frames alike. The sigmas are 0 where nothing was estimated; as large as the
/// prior's they say that the recording did not tell.
struct SensorCorrection
{
  Eigen::Vector2d focal_ratio{ 1, 1 };         ///< true fx, fy over those given
  Eigen::Vector2d principal_shift_px{ 0, 0 };  ///< true cx, cy minus those given
  double depth_ratio = 1;                      ///< true depth = depth_ratio * measured + depth_offset_m
  double depth_offset_m = 0;
  Eigen::Vector2d focal_ratio_sigma{ 0, 0 };
  Eigen::Vector2d principal_shift_sigma_px{ 0, 0 };
  double depth_ratio_sigma = 0;
  double depth_offset_sigma_m = 0;

  bool isIdentity() const;
};

/// The frame as a right sensor had given it. Shares the images that stay as they are.
Frame corrected(const Frame& frame, const SensorCorrection& correction);

}  // namespace object_modelling::rgbd
