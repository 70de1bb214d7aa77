#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::geometry
{
/// A position of an image, neither coordinate negative: the pixel above and to the left of it, and the rest.
struct SubPixel
{
  SubPixel(float u_px, float v_px)
      : u(static_cast<int>(u_px)),
        v(static_cast<int>(v_px)),
        a(u_px - static_cast<float>(u)),
        b(v_px - static_cast<float>(v))
  {
  }
  int u, v;    ///< the upper left of the four pixels round the position
  float a, b;  ///< distance from it along u and v, in [0, 1)
};

/// Whether a position has four pixels round it; false for NaN.
inline bool hasNeighbors(const cv::Mat& image, float u_px, float v_px)
{
  return u_px >= 0 && v_px >= 0 && u_px < static_cast<float>(image.cols - 1) &&
         v_px < static_cast<float>(image.rows - 1);
}

inline float between(float first, float second, float share_of_second)
{
  return (1 - share_of_second) * first + share_of_second * second;
}

/// Of the two values from `upper` on and the two below them; values of one channel are CHANNELS apart.
template <int CHANNELS = 1, typename Value>
float bilinear(const Value* upper, const Value* lower, const SubPixel& at)
{
  return between(between(upper[0], upper[CHANNELS], at.a), between(lower[0], lower[CHANNELS], at.a), at.b);
}

/// Bilinear, of CV_8UC3 or CV_32FC3 at least two pixels wide and high; places outside count as the image's rim.
Eigen::Vector3f colorAt(const cv::Mat& image, const Eigen::Vector2f& pixel);

/// Grey level (CV_8UC1) between its four neighbours, and the slopes (per pixel) of the surface through them; false
/// where there are not four.
bool sampleGray(const cv::Mat& gray, float u_px, float v_px, float* value, Eigen::Vector2f* gradient);

}  // namespace object_modelling::geometry
