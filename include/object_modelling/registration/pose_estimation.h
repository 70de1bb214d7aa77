#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/geometry/normal_equations.h"
#include "object_modelling/geometry/pinhole_camera.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::registration
{
/// A known point (m) and its pixel in the current frame.
struct Correspondence
{
  Eigen::Vector3d p_world;
  Eigen::Vector2d pixel;
  double depth_m = 0;  ///< measured in the current frame; NaN where it has none
};

/// Further constraints on the pose (surfaces, predicted motion), as least squares about one pose near the solution.
struct QuadraticTerm
{
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();  ///< about which the equations are linearised
  geometry::NormalEquations equations;

  geometry::NormalEquations at(const Eigen::Isometry3d& T) const;
};

struct PoseEstimationOptions
{
  double min_pixel_sigma_px = 0.3;  ///< of a landmark's pixel; estimated from the residuals, but no less than this
  double pixel_sigma_px = 0.5;      ///< before there are residuals
  double max_reprojection_error_px = 2.5;  ///< inlier gate; up to twice as wide for a frame whose errors all are large
  double depth_gate_sigmas = 4.0;          ///< depth that fits worse does not count
  int max_hypotheses = 200;                ///< of RANSAC
  double confidence_ratio = 0.99;          ///< chance of having drawn one clean sample, at which RANSAC stops
  int max_iterations = 10;                 ///< of the least squares
  rgbd::SensorNoiseModel noise_model;
};

struct PoseEstimate
{
  bool valid = false;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of T_camera_world, a motion in the camera frame
  std::vector<std::uint8_t> inliers;                           ///< per correspondence
  int inlier_count = 0;
  int close_count = 0;              ///< inliers within max_reprojection_error_px, however wide the gate was
  double reprojection_rmse_px = 0;  ///< of the inliers
};

/// Robust least squares (Huber, iteratively re-weighted Gauss-Newton) on reprojection and depth, each with its sigma,
/// and on `term` if given, from a start that is close. Not valid for fewer than 4 inliers without a term that
/// constrains all six directions.
PoseEstimate refinePose(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera_start, const PoseEstimationOptions& options,
                        const QuadraticTerm* term = nullptr);

/// Seeded, adaptive RANSAC on three 3-D to 3-D correspondences, `T_world_camera_prior` as its first hypothesis, and
/// refinePose() on the result. Not valid for fewer than 4 correspondences.
PoseEstimate estimatePose(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                          const Eigen::Isometry3d& T_world_camera_prior, std::uint64_t seed,
                          const PoseEstimationOptions& options);

}  // namespace object_modelling::registration
