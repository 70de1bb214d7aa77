#pragma once

#include <array>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::registration
{
constexpr int PATCH_HALF = 7;
constexpr int PATCH_SIDE = 2 * PATCH_HALF + 1;
constexpr int PATCH_ROW = 16;  ///< floats from row to row: two registers of eight
constexpr int WINDOW_SIDE = PATCH_SIDE + 2;
constexpr int WINDOW_ROW = 24;

/// A patch of a reference image without its mean, with its gradient. The last column of each row is zero.
struct PatchTemplate
{
  using Values = std::array<float, PATCH_SIDE * PATCH_ROW>;
  alignas(32) Values value, gradient_x, gradient_y;
  float variance = 0;  ///< sum of squares of `value`
};

/// A patch of an image with a border of one pixel; what lies beyond a row's pixels is zero.
struct PatchWindow
{
  alignas(32) std::array<float, WINDOW_SIDE * WINDOW_ROW> pixels;
};

/// How a window differs from gain * template + bias with the best gain and bias.
struct PatchDifference
{
  float gain = 0;
  float variance = 0;    ///< of the window, as PatchTemplate::variance
  float covariance = 0;  ///< with the template
  /// Normal equations of the shift, without the directions of gain and bias: A shift = -b.
  float a_xx = 0, a_xy = 0, a_yy = 0, b_x = 0, b_y = 0;
};

/// The image at H [x y 1]^T for x, y = 0 ... WINDOW_SIDE - 1; every position must be inside it.
void warpWindow(const cv::Mat& image, const Eigen::Matrix3f& H, PatchWindow* window);

/// The image from (u, v) on, `a` and `b` of a pixel further; (u + WINDOW_SIDE, v + WINDOW_SIDE) must be inside it.
void shiftWindow(const cv::Mat& image, int u, int v, float a, float b, PatchWindow* window);

void makeTemplate(const PatchWindow& window, PatchTemplate* patch);

/// Sums over the patch; gradients are the mean of the template's, times gain, and the window's.
void comparePatch(const PatchTemplate& patch, const PatchWindow& window, PatchDifference* difference);

}  // namespace object_modelling::registration
