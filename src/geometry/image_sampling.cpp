#include "object_modelling/geometry/image_sampling.h"

#include <algorithm>
#include <cstdint>

namespace object_modelling::geometry
{
namespace
{
template <typename Value>
Eigen::Vector3f colorOf(const cv::Mat& image, const SubPixel& at)
{
  const Value* upper = image.ptr<Value>(at.v) + 3 * at.u;
  const Value* lower = image.ptr<Value>(at.v + 1) + 3 * at.u;
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c)
    color[c] = bilinear<3>(upper + c, lower + c, at);
  return color;
}
}  // namespace

Eigen::Vector3f colorAt(const cv::Mat& image, const Eigen::Vector2f& pixel)
{
  SubPixel at(std::clamp(pixel.x(), 0.f, static_cast<float>(image.cols - 1)),
              std::clamp(pixel.y(), 0.f, static_cast<float>(image.rows - 1)));
  if (at.u > image.cols - 2)
  {
    --at.u;
    at.a = 1;
  }
  if (at.v > image.rows - 2)
  {
    --at.v;
    at.b = 1;
  }
  return image.type() == CV_8UC3 ? colorOf<std::uint8_t>(image, at) : colorOf<float>(image, at);
}

bool sampleGray(const cv::Mat& gray, float u_px, float v_px, float* value, Eigen::Vector2f* gradient)
{
  if (!hasNeighbors(gray, u_px, v_px))
    return false;
  const SubPixel at(u_px, v_px);
  const auto* upper = gray.ptr<std::uint8_t>(at.v) + at.u;
  const auto* lower = gray.ptr<std::uint8_t>(at.v + 1) + at.u;
  // By the slopes, which are asked for anyway.
  const auto top = static_cast<float>(upper[1] - upper[0]), bottom = static_cast<float>(lower[1] - lower[0]);
  const float left = upper[0] + at.a * top, right = lower[0] + at.a * bottom;
  *value = between(left, right, at.b);
  *gradient = { between(top, bottom, at.b), right - left };
  return true;
}

}  // namespace object_modelling::geometry
