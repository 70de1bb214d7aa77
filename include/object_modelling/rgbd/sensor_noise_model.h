#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
/// Kinect-type noise after Nguyen, Izadi, Lovell: Modeling Kinect Sensor Noise for Improved 3D Reconstruction and
/// Tracking, 3DIMPVT 2012. theta is the angle between surface normal and viewing ray, in [0, pi/2); from pi/2 on the
/// surface cannot be seen and the sigmas are infinite.
double axialSigma_m(double z_m, double theta_rad);
double lateralSigma_px(double theta_rad);
/// lateralSigma_px * z / f: the factor z / f once (V4R applied z twice, right at 1 m only).
double lateralSigma_m(double z_m, double theta_rad, double focal_px);

struct ObservationWeightOptions
{
  double theta_max_rad = 1.0471975511965976;  ///< 60 deg; flat weight below, falls to 0 at 90 deg
  double sigma_lateral_m = 0.002;             ///< width of the dip at depth edges
  std::vector<std::string> violations() const;
};

/// Noise weight of the paper (Aldoma et al. 2015, Eq. 1) in [0, 1], corrected: first factor clamped to 1 below
/// theta_max and 0 above 90 deg; the exponent has the minus sign that the printed form lacks:
///   w = (1 - (theta - theta_max) / (90 deg - theta_max)) (1 - 1/2 exp(-d^2 / sigma_L^2)),
/// d in m: distance on the surface to the nearest depth edge, theta measured against the viewing ray.
double observationWeight(double theta_rad, double edge_distance_m, const ObservationWeightOptions& options = {});

/// Weight per pixel, CV_32FC1, 0 where depth or normal is missing. `normals` as from computeNormals; the distance in
/// pixels becomes metres by z / f.
cv::Mat observationWeights(const Frame& frame, const cv::Mat& normals, const cv::Mat& edge_distance_px,
                           const ObservationWeightOptions& options = {});

}  // namespace object_modelling::rgbd
