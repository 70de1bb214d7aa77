#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::features
{
/// A point seen in two keyframes, in metres in the optical frame of each, with the sigmas of its pixels.
struct PointPair
{
  Eigen::Vector3d p_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_b = Eigen::Vector3d::Zero();
  double sigma_a_px = 1, sigma_b_px = 1;
};

struct RelativePoseOptions
{
  int max_iterations = 3000;  ///< of RANSAC
  double gate_sigmas = 4;     ///< a pair is an inlier within this Mahalanobis distance
  std::uint64_t seed = 1;
};

struct RelativePose
{
  bool found = false;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  std::vector<int> inliers;  ///< indices of pairs, ascending
};

/// Rigid motion between two views from 3-D point pairs: seeded RANSAC over triples, then iteratively reweighted least
/// squares on the full covariance of every back-projected point (lateral from the pixel sigma, axial from the depth
/// noise). Not found for fewer than 3 pairs or when no triple agrees with any other pair.
RelativePose estimateRelativePose(const std::vector<PointPair>& pairs, const rgbd::Frame& frame_a,
                                  const rgbd::Frame& frame_b, const RelativePoseOptions& options);

/// Pairs within `gate_sigmas` of a given motion, ascending.
std::vector<int> inliersOf(const Eigen::Isometry3d& T_a_b, const std::vector<PointPair>& pairs,
                           const rgbd::Frame& frame_a, const rgbd::Frame& frame_b, double gate_sigmas);

/// Covariance of a point back-projected from its pixel and depth, in the optical frame.
Eigen::Matrix3d backProjectionCovariance(const Eigen::Vector3d& p_camera, const rgbd::Frame& frame, double sigma_px);

}  // namespace object_modelling::features
