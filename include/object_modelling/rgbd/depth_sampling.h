#pragma once

#include <algorithm>
#include <limits>

#include <opencv2/core.hpp>

#include "object_modelling/geometry/image_sampling.h"

namespace object_modelling::rgbd
{
/// Depth between four neighbours.
struct DepthBetween
{
  float z_m;        ///< bilinear; NaN if one of them is missing
  float nearest_m;  ///< of them
  float step_m;     ///< between the nearest and the farthest of them
};

/// `at` has four neighbours.
inline DepthBetween depthBetween(const cv::Mat& depth_m, const geometry::SubPixel& at)
{
  const float* upper = depth_m.ptr<float>(at.v) + at.u;
  const float* lower = depth_m.ptr<float>(at.v + 1) + at.u;
  const float nearest_m = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
  const float farthest_m = std::max(std::max(upper[0], upper[1]), std::max(lower[0], lower[1]));
  return { geometry::bilinear(upper, lower, at), nearest_m, farthest_m - nearest_m };
}

/// Depth (m) at any position, where its four neighbours are one surface: they differ by at most `max_step_ratio` of the
/// nearest. NaN elsewhere, at holes and outside the image.
inline float sampleDepth_m(const cv::Mat& depth_m, float u_px, float v_px, float max_step_ratio = 0.015F)
{
  constexpr float MISSING = std::numeric_limits<float>::quiet_NaN();
  if (!geometry::hasNeighbors(depth_m, u_px, v_px))
    return MISSING;
  const DepthBetween depth = depthBetween(depth_m, { u_px, v_px });
  return depth.step_m <= max_step_ratio * depth.nearest_m ? depth.z_m : MISSING;
}

}  // namespace object_modelling::rgbd
