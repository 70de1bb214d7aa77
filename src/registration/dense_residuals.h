#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/registration/dense_pyramid.h"

namespace object_modelling::registration
{
/// A reference point as a frame sees it.
struct DenseResidual
{
  Eigen::Vector3f q;         ///< predicted, in the camera frame
  Eigen::Vector3f normal;    ///< rotated into it
  float depth_residual = 0;  ///< along the normal, m
  float depth_sigma = 0;     ///< of it
  float intensity_residual = 0;
  float reference_intensity = 0;
  float gradient_x = 0, gradient_y = 0;  ///< of the frame, grey levels per pixel of the level
  bool has_depth = false;
  bool textured = false;
};

/// What a frame measures at the points of a reference. Its memory is used again by the next call of observe().
struct DenseResiduals
{
  std::vector<DenseResidual> all;
  double pixels_per_point = 1, edges_per_point = 1;  ///< as DensePoints
  int in_view = 0;                                   ///< points that project into the frame and are not hidden
  int with_depth = 0;                                ///< of them with a normal and measured depth ...
  int agreeing = 0;                                  ///< ... and where that is as predicted
  double correlation = 0;                            ///< of the intensities
  float depth_scale = 1;      ///< robust standard deviation of the depth residuals over their sigma
  float intensity_scale = 1;  ///< of the intensity residuals, grey levels
};

/// Standard deviation of a difference of two depths, averaged over neighbours, along the optical axis.
float averagedDepthSigma_m(const rgbd::SensorNoiseModel& noise_model, float z_m);

/// Depth and intensity residuals, the exposure of the frame brought to that of the reference.
void observe(const DensePoints& points, const DenseLevel& level, const Eigen::Isometry3d& T_camera_reference,
             DenseResiduals* residuals);

}  // namespace object_modelling::registration
