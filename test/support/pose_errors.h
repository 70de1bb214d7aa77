#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::test_support
{
inline Eigen::Isometry3d& poseOf(rgbd::Keyframe& keyframe)
{
  return keyframe.T_session_camera;
}
inline Eigen::Isometry3d& poseOf(rgbd::View& view)
{
  return view.T_world_camera;
}

/// Of keyframes or views.
template <typename Posed>
std::vector<Eigen::Isometry3d> posesOf(std::vector<Posed> posed)
{
  std::vector<Eigen::Isometry3d> poses;
  for (Posed& one : posed)
    poses.push_back(poseOf(one));
  return poses;
}

/// Poses but the first moved at random, each on its own.
template <typename Posed>
std::vector<Posed> perturbed(std::vector<Posed> posed, double translation_m, double rotation_rad, unsigned seed = 3)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t k = 1; k < posed.size(); ++k)
  {
    geometry::Vector6d motion;
    for (int i = 0; i < 6; ++i)
      motion[i] = normal(random) * (i < 3 ? translation_m : rotation_rad) / std::sqrt(3.0);
    poseOf(posed[k]) = poseOf(posed[k]) * geometry::isometryFromVector(motion);
  }
  return posed;
}

struct PoseError
{
  double translation_m = 0;  ///< largest of all
  double rotation_rad = 0;
};

template <typename Posed>
PoseError largestError(const std::vector<Eigen::Isometry3d>& estimated, const std::vector<Posed>& truth)
{
  const std::vector<Eigen::Isometry3d> true_poses = posesOf(truth);
  PoseError error;
  for (std::size_t k = 0; k < true_poses.size(); ++k)
  {
    const Eigen::Isometry3d difference = true_poses[k].inverse() * estimated[k];
    error.translation_m = std::max(error.translation_m, difference.translation().norm());
    error.rotation_rad = std::max(error.rotation_rad, geometry::rotationAngle_rad(difference));
  }
  return error;
}

}  // namespace object_modelling::test_support
