#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::bundle_adjustment
{
/// Gives every keyframe and its next common landmarks, from the depth images and the exact poses, with pixel noise:
/// what a tracker leaves behind that follows points from keyframe to keyframe and no further. On the mask only, if
/// asked.
inline void observeNeighbors(std::vector<rgbd::Keyframe>* keyframes, double pixel_noise_px, int step_px,
                             bool object_only)
{
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, pixel_noise_px);
  std::uint64_t next_id = 0;
  for (std::size_t k = 0; k + 1 < keyframes->size(); ++k)
  {
    rgbd::Keyframe& a = (*keyframes)[k];
    rgbd::Keyframe& b = (*keyframes)[k + 1];
    const Eigen::Isometry3d T_b_a = b.T_session_camera.inverse() * a.T_session_camera;
    for (int v = step_px; v < a.frame.depth_m.rows; v += step_px)
    {
      for (int u = step_px; u < a.frame.depth_m.cols; u += step_px)
      {
        if (!(a.frame.depthAt_m(u, v) > 0) || (object_only && a.frame.object_mask.at<std::uint8_t>(v, u) == 0))
          continue;
        const Eigen::Vector3d p_b = T_b_a * a.frame.point(u, v).cast<double>();
        const Eigen::Vector2d pixel = b.frame.camera.project(p_b);
        if (!(p_b.z() > 0) || !b.frame.camera.contains(pixel, 2))
          continue;
        const float z = b.frame.depthAt_m(std::lround(pixel.x()), std::lround(pixel.y()));
        if (!(std::abs(z - p_b.z()) < 0.01))
          continue;
        const Eigen::Vector2f noise_a(normal(random), normal(random)), noise_b(normal(random), normal(random));
        a.observations.push_back({ next_id, Eigen::Vector2f(u, v) + noise_a, a.frame.depthAt_m(u, v) });
        b.observations.push_back({ next_id, pixel.cast<float>() + noise_b, z });
        ++next_id;
      }
    }
  }
}

/// Every step from keyframe to keyframe off by the same small motion, so that the last ends up `count` times that off.
inline std::vector<rgbd::Keyframe> drifted(std::vector<rgbd::Keyframe> keyframes, const geometry::Vector6d& per_step)
{
  const std::vector<rgbd::Keyframe> truth = keyframes;
  for (std::size_t k = 1; k < keyframes.size(); ++k)
  {
    keyframes[k].T_session_camera = keyframes[k - 1].T_session_camera *
                                    (truth[k - 1].T_session_camera.inverse() * truth[k].T_session_camera) *
                                    geometry::isometryFromVector(per_step);
  }
  return keyframes;
}

}  // namespace object_modelling::bundle_adjustment
