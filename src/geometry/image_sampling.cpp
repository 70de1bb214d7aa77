#include "object_modelling/geometry/image_sampling.h"

#include <algorithm>

namespace object_modelling::geometry
{
namespace
{
template <typename Pixel>
Eigen::Vector3f bilinear(const cv::Mat& image, const Eigen::Vector2f& pixel)
{
  const float u = std::clamp(pixel.x(), 0.f, static_cast<float>(image.cols - 1));
  const float v = std::clamp(pixel.y(), 0.f, static_cast<float>(image.rows - 1));
  const int x = std::min(static_cast<int>(u), image.cols - 2), y = std::min(static_cast<int>(v), image.rows - 2);
  const float a = u - static_cast<float>(x), b = v - static_cast<float>(y);
  const Pixel* upper = image.ptr<Pixel>(y) + x;
  const Pixel* lower = image.ptr<Pixel>(y + 1) + x;
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c)
    color[c] = (1 - b) * ((1 - a) * upper[0][c] + a * upper[1][c]) + b * ((1 - a) * lower[0][c] + a * lower[1][c]);
  return color;
}
}  // namespace

Eigen::Vector3f colorAt(const cv::Mat& image, const Eigen::Vector2f& pixel)
{
  return image.type() == CV_8UC3 ? bilinear<cv::Vec3b>(image, pixel) : bilinear<cv::Vec3f>(image, pixel);
}

}  // namespace object_modelling::geometry
