#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/rgbd/distortion_grid.h"
#include "object_modelling/rgbd/sensor_correction.h"

namespace object_modelling::rgbd
{
/// Noise of a depth sensor. The defaults are a Kinect's after Nguyen, Izadi, Lovell: Modeling Kinect Sensor Noise for
/// Improved 3D Reconstruction and Tracking, 3DIMPVT 2012; docs/noise_model.md: how to measure another sensor's.
///
///   sigma_z = axial_constant + axial_quadratic (z - axial_vertex)^2
///             + axial_grazing / sqrt(z) theta^2 / (90 deg - theta)^2   if theta > axial_grazing_from
///   sigma_L = lateral_constant + lateral_grazing theta / (90 deg - theta)
///   measured z - true z = depth_bias_constant + depth_bias_linear z + depth_bias_quadratic z^2 + distortion(u, v) z
///   pixel of a point in the colour image - its pixel in the depth image = color_offset
///
/// z is along the optical axis, theta the angle between surface normal and viewing ray, in [0, 90 deg); from there on
/// the surface cannot be seen and the sigmas are infinite. Bias and offset are taken off by FrameBuilder, once: every
/// frame's depth and colour are corrected already.
struct SensorNoiseModel
{
  double axial_constant_m = 0.0012;
  double axial_quadratic_per_m = 0.0019;
  double axial_vertex_m = 0.4;
  double axial_grazing_m_sqrt_m = 0.0001;              ///< unit: metre times root of metre
  double axial_grazing_from_rad = 1.0471975511965976;  ///< 60 deg
  double lateral_constant_px = 0.8;
  double lateral_grazing_px = 0.035;
  double depth_bias_constant_m = 0;
  double depth_bias_linear_ratio = 0;
  double depth_bias_quadratic_per_m = 0;
  double color_offset_x_px = 0, color_offset_y_px = 0;
  DistortionGrid::Ratios depth_distortion_ratio{};

  double axialSigma_m(double z_m, double theta_rad) const;
  double lateralSigma_px(double theta_rad) const;
  /// lateralSigma_px * z / f: the factor z / f once (V4R applied z twice, right at 1 m only).
  double lateralSigma_m(double z_m, double theta_rad, double focal_px) const;

  /// Measured minus true depth, without the distortion; `z_m` is the measured depth.
  double depthBias_m(double z_m) const;
  bool correctsDepth() const;
  bool shiftsColor() const { return color_offset_x_px != 0 || color_offset_y_px != 0; }

  bool operator==(const SensorNoiseModel& other) const;
  bool operator!=(const SensorNoiseModel& other) const { return !(*this == other); }
  /// Every coefficient that is out of its bound, as options have it.
  std::vector<std::string> violations() const;
};

/// What is known of the sensor that recorded a session.
struct SensorCalibration
{
  SensorNoiseModel noise_model;
  /// What the frames have left of the noise model's offset: pixel of a point in the colour image minus its pixel in the
  /// depth image; zero where not known.
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
  SensorCorrection correction;  ///< of frames as they came; identity where not known

  bool operator==(const SensorCalibration& other) const
  {
    return noise_model == other.noise_model && color_offset_px == other.color_offset_px &&
           correction == other.correction;
  }
};

}  // namespace object_modelling::rgbd
