#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::test_support
{
/// Poses but the first moved at random, each on its own.
inline std::vector<rgbd::Keyframe> perturbed(std::vector<rgbd::Keyframe> keyframes, double translation_m,
                                             double rotation_rad, unsigned seed = 3)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t k = 1; k < keyframes.size(); ++k)
  {
    geometry::Vector6d motion;
    for (int i = 0; i < 6; ++i)
      motion[i] = normal(random) * (i < 3 ? translation_m : rotation_rad) / std::sqrt(3.0);
    keyframes[k].T_session_camera = keyframes[k].T_session_camera * geometry::isometryFromVector(motion);
  }
  return keyframes;
}

struct PoseError
{
  double translation_m = 0;  ///< largest of all keyframes
  double rotation_rad = 0;
};

inline PoseError largestError(const std::vector<Eigen::Isometry3d>& estimated, const std::vector<rgbd::Keyframe>& truth)
{
  PoseError error;
  for (std::size_t k = 0; k < truth.size(); ++k)
  {
    const Eigen::Isometry3d difference = truth[k].T_session_camera.inverse() * estimated[k];
    error.translation_m = std::max(error.translation_m, difference.translation().norm());
    error.rotation_rad = std::max(error.rotation_rad, geometry::rotationAngle_rad(difference));
  }
  return error;
}

}  // namespace object_modelling::test_support
