#include "working_image.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/rgbd/normals.h"

namespace object_modelling::segmentation
{
WorkingImage makeWorkingImage(const rgbd::Frame& frame, const cv::Mat& ignored)
{
  constexpr double WORKING_PIXELS = 213.0 * 160.0;
  WorkingImage image;
  const int width = frame.depth_m.cols, height = frame.depth_m.rows;
  image.step = std::max(1, static_cast<int>(std::lround(std::sqrt(width * height / WORKING_PIXELS))));
  const int step = image.step;
  image.frame.depth_m.create((height + step - 1) / step, (width + step - 1) / step, CV_32FC1);
  for (int v = 0; v < image.frame.depth_m.rows; ++v)
  {
    const auto* from = frame.depth_m.ptr<float>(v * step);
    auto* to = image.frame.depth_m.ptr<float>(v);
    for (int u = 0; u < image.frame.depth_m.cols; ++u)
      to[u] = !ignored.empty() && ignored.at<std::uint8_t>(v * step, u * step) != 0 ? std::nanf("") : from[u * step];
  }
  image.frame.noise_model = frame.noise_model;
  geometry::PinholeCamera& camera = image.frame.camera;
  camera = frame.camera;
  camera.width = image.frame.depth_m.cols;
  camera.height = image.frame.depth_m.rows;
  camera.fx /= step;
  camera.fy /= step;
  camera.cx /= step;
  camera.cy /= step;
  rgbd::NormalOptions options;
  options.radius_px = 3;
  options.max_depth_step_ratio = 0.04;  // a table seen at 10 deg of elevation falls off so fast from pixel to pixel
  image.normals = rgbd::computeNormals(image.frame, options);
  return image;
}

}  // namespace object_modelling::segmentation
