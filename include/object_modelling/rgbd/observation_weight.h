#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
enum class WeightModel
{
  PAPER,          ///< Eq. 1 of the paper with the minus sign that it needs
  PAPER_PRINTED,  ///< Eq. 1 as printed, for comparison only
  NGUYEN          ///< inverse variance of the frame's noise model
};

struct ObservationWeightOptions
{
  WeightModel model = WeightModel::PAPER;
  double theta_max_rad = 1.0471975511965976;  ///< 60 deg; flat weight below, falls to 0 at 90 deg; not for NGUYEN
  double sigma_lateral_m = 0.002;             ///< width of the dip at depth edges; not for NGUYEN
  std::vector<std::string> violations() const;
};

/// Noise weight of the paper (Aldoma et al. 2015, Eq. 1) in [0, 1], corrected: first factor clamped to 1 below
/// theta_max and 0 above 90 deg; the exponent has the minus sign that the printed form lacks:
///   w = (1 - (theta - theta_max) / (90 deg - theta_max)) (1 - 1/2 exp(-d^2 / sigma_L^2)),
/// d in m: distance on the surface to the nearest depth edge, theta measured against the viewing ray.
/// As printed, with exp(+d^2 / sigma_L^2), the second factor falls away from edges and is not positive from
/// d = sigma_L sqrt(ln 2) = 0.83 sigma_L on, 1.7 mm by default; that counts as 0, so only a fringe of the surface is
/// left.
double paperWeight(double theta_rad, double edge_distance_m, const ObservationWeightOptions& options = {});

/// Inverse variance as a share of the best one the model has: (sigma_min / sigma_z(z, theta))^2 in [0, 1], sigma_min
/// that of a surface seen square on at the model's vertex.
double nguyenWeight(const SensorNoiseModel& noise_model, double z_m, double theta_rad);

/// Weight per pixel, CV_32FC1, 0 where depth or normal is missing. `normals` as from computeNormals; the distance in
/// pixels becomes metres by z / f.
cv::Mat observationWeights(const Frame& frame, const cv::Mat& normals, const cv::Mat& edge_distance_px,
                           const ObservationWeightOptions& options = {});

}  // namespace object_modelling::rgbd
