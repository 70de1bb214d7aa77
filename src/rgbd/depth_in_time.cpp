#include "object_modelling/rgbd/depth_in_time.h"

#include <cmath>
#include <limits>

#include "object_modelling/geometry/image_sampling.h"

namespace object_modelling::rgbd
{
namespace
{
constexpr float MAX_STEP_RATIO = 0.02F;  // a mean of depths further apart is a place on neither surface

/// Between the four pixels around, or the nearest of them if they are not of one surface. `at` has four neighbours.
float sample(const cv::Mat& depth_m, const geometry::SubPixel& at)
{
  const float* upper = depth_m.ptr<float>(at.v) + at.u;
  const float* lower = depth_m.ptr<float>(at.v + 1) + at.u;
  const float mean = geometry::bilinear(upper, lower, at);
  const float nearest = (at.b < 0.5F ? upper : lower)[at.a < 0.5F ? 0 : 1];
  // False where one is missing, too.
  return std::abs(mean - nearest) <= MAX_STEP_RATIO * nearest ? mean : nearest;
}
}  // namespace

cv::Mat moveDepth(const cv::Mat& depth_m, const geometry::PinholeCamera& camera, const Eigen::Isometry3d& T_color_depth)
{
  const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  const Eigen::Isometry3f T = T_color_depth.inverse().cast<float>();
  const Eigen::Matrix3f R = T.linear();
  const Eigen::Vector3f t = T.translation(), z_axis = R.col(2);
  const Eigen::ArrayXf ray_x =
      (Eigen::ArrayXf::LinSpaced(depth_m.cols, 0, static_cast<float>(depth_m.cols - 1)) - cx) / fx;
  const float t_z = z_axis.dot(t);
  Eigen::ArrayXf inverse_z, scale, x, y, scale_z;
  cv::Mat moved(depth_m.size(), CV_32FC1);
  for (int v = 0; v < depth_m.rows; ++v)
  {
    // Where each pixel's surface is in the depth image. The surface that was at the pixel when the depth was taken
    // stands for the one that is there now: they differ at steps alone.
    const Eigen::Vector3f row = R.col(1) * ((static_cast<float>(v) - cy) / fy) + R.col(2);
    inverse_z = Eigen::Map<const Eigen::ArrayXf>(depth_m.ptr<float>(v), depth_m.cols).inverse();
    scale = (R(2, 0) * ray_x + (row[2] + t[2] * inverse_z)).inverse();
    x = fx * scale * (R(0, 0) * ray_x + (row[0] + t[0] * inverse_z)) + cx;
    y = fy * scale * (R(1, 0) * ray_x + (row[1] + t[1] * inverse_z)) + cy;
    // z after the motion = scale_z z - t_z, where z is the depth there.
    scale_z = z_axis[0] / fx * (x - cx) + z_axis[1] / fy * (y - cy) + z_axis[2];
    auto* out = moved.ptr<float>(v);
    for (int u = 0; u < depth_m.cols; ++u)
    {
      out[u] = geometry::hasNeighbors(depth_m, x[u], y[u]) ? scale_z[u] * sample(depth_m, { x[u], y[u] }) - t_z
                                                           : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return moved;
}

}  // namespace object_modelling::rgbd
