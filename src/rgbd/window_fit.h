#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/geometry/pinhole_camera.h"
#include "object_modelling/rgbd/normals.h"

namespace object_modelling::rgbd
{
/// A plane n . X = d seen by a pinhole camera has inverse depth w = A u + B v + C, linear in the pixel, with
/// n ~ (A fx, B fy, A cx + B cy + C). The two fits below find A, B, C by least squares over a square window: in closed
/// form where the whole window is one surface, by gated sums where it is not.

struct FloatIntrinsics
{
  explicit FloatIntrinsics(const geometry::PinholeCamera& camera)
      : fx(static_cast<float>(camera.fx)),
        fy(static_cast<float>(camera.fy)),
        cx(static_cast<float>(camera.cx)),
        cy(static_cast<float>(camera.cy))
  {
  }
  float fx, fy, cx, cy;
};

/// Depth and inverse depth with a margin of one window radius; 0 where missing and in the margin.
class PaddedDepth
{
public:
  PaddedDepth(const cv::Mat& depth_m, int radius_px);

  int radius() const { return radius_; }
  cv::Size size() const { return { depth_.cols - 2 * radius_ - SLACK, depth_.rows - 2 * radius_ }; }
  /// Row of the image, at its column 0; rows and columns reach one radius beyond the image.
  const float* depthRow(int v) const { return depth_.ptr<float>(v + radius_) + radius_; }
  const float* inverseRow(int v) const { return inverse_.ptr<float>(v + radius_) + radius_; }
  const cv::Mat& depth() const { return depth_; }

private:
  static constexpr int SLACK = 4;  ///< columns more on the right: four pixels at a time may reach past the end

  int radius_;
  cv::Mat depth_, inverse_;
};

/// CV_8UC1, 255 where every pixel of the window has depth within `step_ratio` of the centre's.
cv::Mat wholeWindows(const PaddedDepth& padded, float step_ratio);

/// For whole windows the normal equations are diagonal: A = sum(du w) / sum(du^2), likewise B, and C the mean.
class WholeWindowFit
{
public:
  WholeWindowFit(const PaddedDepth& padded, const geometry::PinholeCamera& camera);
  /// Normals of the marked pixels of one row.
  void row(int v, const std::uint8_t* marked, cv::Vec3f* normals);

private:
  void horizontalSums(int v);
  float* sums(std::vector<float>* ring, int v) { return ring->data() + ((v + radius_) % window_) * width_; }

  const PaddedDepth& padded_;
  FloatIntrinsics camera_;
  int radius_, window_, width_;
  int next_row_;                        ///< first image row whose horizontal sums are not in the rings yet
  std::vector<float> sum_w_, sum_u_w_;  ///< rings of `window_` rows: sum of w, of du w
  std::vector<float> total_w_, total_u_w_, total_v_w_;
};

/// Sums over the pixels within the depth gate only, for four neighbouring pixels at once.
class GatedWindowFit
{
public:
  GatedWindowFit(const PaddedDepth& padded, const geometry::PinholeCamera& camera, const NormalOptions& options);
  /// Normals of the pixels of one row that have depth and are not marked.
  void row(int v, const std::uint8_t* marked, cv::Vec3f* normals) const;

private:
  static constexpr int LANES = 4;
  /// Moments of the gated pixels about the centre pixel and its inverse depth.
  struct Moments
  {
    float n[LANES], u[LANES], v[LANES], uu[LANES], uv[LANES], vv[LANES], w[LANES], uw[LANES], vw[LANES];
  };

  Moments sums(int v, int u) const;
  void solve(const Moments& moments, int lane, int u, int v, cv::Vec3f* normal) const;

  const PaddedDepth& padded_;
  FloatIntrinsics camera_;
  float step_ratio_;
  float min_count_;
};

}  // namespace object_modelling::rgbd
