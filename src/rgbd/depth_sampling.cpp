#include "object_modelling/rgbd/depth_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace object_modelling::rgbd
{
float sampleDepth_m(const cv::Mat& depth_m, float u_px, float v_px, float max_step_ratio)
{
  constexpr float MISSING = std::numeric_limits<float>::quiet_NaN();
  const int u = static_cast<int>(std::floor(u_px));
  const int v = static_cast<int>(std::floor(v_px));
  if (!(u >= 0 && v >= 0 && u + 1 < depth_m.cols && v + 1 < depth_m.rows))
    return MISSING;
  const float* upper = depth_m.ptr<float>(v) + u;
  const float* lower = depth_m.ptr<float>(v + 1) + u;
  const float nearest = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
  const float farthest = std::max(std::max(upper[0], upper[1]), std::max(lower[0], lower[1]));
  const float sum = upper[0] + upper[1] + lower[0] + lower[1];  // NaN if any of them is
  if (std::isnan(sum) || farthest - nearest > max_step_ratio * nearest)
    return MISSING;
  const float a = u_px - static_cast<float>(u);
  const float b = v_px - static_cast<float>(v);
  return (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
}

}  // namespace object_modelling::rgbd
