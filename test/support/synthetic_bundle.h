#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::test_support
{
struct SyntheticBundleOptions
{
  int camera_count = 12;
  double step_rad = 0;  ///< from camera to camera; 0: evenly once round the landmarks
  int landmark_count = 400;
  double radius_m = 0.7;
  double elevation_rad = 0.6;
  double pixel_sigma_px = 0;     ///< noise of the observations
  double depth_sigma_scale = 0;  ///< share of the axial sigma of Nguyen 2012
  double outlier_ratio = 0;      ///< observations moved to a random pixel, 20 px off or more
  double missing_depth_ratio = 0;
  double pose_error_m = 0;    ///< sigma per axis of the keyframes' poses; the first stays exact
  double pose_error_rad = 0;  ///< likewise
  std::uint64_t seed = 1;
};

/// Keyframes without images, whose observations see landmarks on a sphere of 0.3 m diameter from the side that faces
/// the camera. The session frame is the first camera.
struct SyntheticBundle
{
  std::vector<rgbd::Keyframe> keyframes;                ///< with perturbed poses and noisy observations
  std::vector<Eigen::Isometry3d> T_session_cameras;     ///< truth
  std::vector<Eigen::Vector3d> landmarks;               ///< truth, session frame; index is the landmark_id
  std::vector<std::vector<bool>> observation_outliers;  ///< as keyframes[i].observations[j]
};

SyntheticBundle makeSyntheticBundle(const SyntheticBundleOptions& options = {});

}  // namespace object_modelling::test_support
