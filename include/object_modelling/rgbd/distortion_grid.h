#pragma once

#include <array>

#include <opencv2/core.hpp>

namespace object_modelling::rgbd
{
/// Smooth distortion of depth images: the share of the depth that is measured too much, at knots that divide the image
/// evenly from its first to its last pixel, row by row; bilinear between them.
struct DistortionGrid
{
  static constexpr int COLUMNS = 9;
  static constexpr int ROWS = 7;
  static constexpr int KNOTS = COLUMNS * ROWS;
  using Ratios = std::array<double, KNOTS>;

  /// The four knots round a pixel of an image of the given size, and their shares in the value there; they sum to 1.
  struct Shares
  {
    std::array<int, 4> knot{};
    std::array<double, 4> share{};
  };
  static Shares sharesAt(double u_px, double v_px, int width_px, int height_px);
  /// The value at a pixel of an image of the given size.
  static double ratioAt(const Ratios& ratios, double u_px, double v_px, int width_px, int height_px);
  /// The values at all pixels, CV_32FC1.
  static cv::Mat image(const Ratios& ratios, const cv::Size& size);
};

}  // namespace object_modelling::rgbd
