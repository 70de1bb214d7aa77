#include "window_fit.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

namespace object_modelling::rgbd
{
namespace
{
/// Normal of the plane w = w_centre + a (u - u_centre) + b (v - v_centre), towards the camera.
inline cv::Vec3f normalOf(const FloatIntrinsics& camera, int u, int v, float a, float b, float w_center)
{
  const float x = a * camera.fx;
  const float y = b * camera.fy;
  const float z = w_center + a * (camera.cx - static_cast<float>(u)) + b * (camera.cy - static_cast<float>(v));
  const float scale = -1.0f / std::sqrt(x * x + y * y + z * z);
  return { x * scale, y * scale, z * scale };
}

}  // namespace

PaddedDepth::PaddedDepth(const cv::Mat& depth_m, int radius_px)
    : radius_(radius_px),
      depth_(cv::Mat::zeros(depth_m.rows + 2 * radius_px, depth_m.cols + 2 * radius_px + SLACK, CV_32FC1)),
      inverse_(cv::Mat::zeros(depth_.size(), CV_32FC1))
{
  for (int v = 0; v < depth_m.rows; ++v)
  {
    const auto* in = depth_m.ptr<float>(v);
    float* depth = depth_.ptr<float>(v + radius_) + radius_;
    float* inverse = inverse_.ptr<float>(v + radius_) + radius_;
    for (int u = 0; u < depth_m.cols; ++u)
    {
      depth[u] = in[u] > 0 ? in[u] : 0.0f;
      inverse[u] = in[u] > 0 ? 1.0f / in[u] : 0.0f;
    }
  }
}

cv::Mat wholeWindows(const PaddedDepth& padded, float step_ratio)
{
  const int window = 2 * padded.radius() + 1;
  const cv::Mat kernel = cv::Mat::ones(window, window, CV_8UC1);
  cv::Mat nearest;
  cv::Mat farthest;
  cv::erode(padded.depth(), nearest, kernel);
  cv::dilate(padded.depth(), farthest, kernel);
  cv::Mat whole(padded.size(), CV_8UC1);
  for (int v = 0; v < whole.rows; ++v)
  {
    const float* depth = padded.depthRow(v);
    const float* low = nearest.ptr<float>(v + padded.radius()) + padded.radius();
    const float* high = farthest.ptr<float>(v + padded.radius()) + padded.radius();
    auto* out = whole.ptr<std::uint8_t>(v);
    for (int u = 0; u < whole.cols; ++u)
    {
      const float gate = step_ratio * depth[u];
      out[u] = ((low[u] > 0) & (depth[u] - low[u] <= gate) & (high[u] - depth[u] <= gate)) ? 255 : 0;
    }
  }
  return whole;
}

WholeWindowFit::WholeWindowFit(const PaddedDepth& padded, const geometry::PinholeCamera& camera)
    : padded_(padded),
      camera_(camera),
      radius_(padded.radius()),
      window_(2 * radius_ + 1),
      width_(padded.size().width),
      next_row_(-radius_),
      sum_w_(static_cast<std::size_t>(window_ * width_)),
      sum_u_w_(sum_w_.size()),
      total_w_(static_cast<std::size_t>(width_)),
      total_u_w_(total_w_.size()),
      total_v_w_(total_w_.size())
{
}

void WholeWindowFit::horizontalSums(int v)
{
  const float* inverse = padded_.inverseRow(v);
  float* sum_w = sums(&sum_w_, v);
  float* sum_u_w = sums(&sum_u_w_, v);
  std::copy(inverse, inverse + width_, sum_w);
  std::fill(sum_u_w, sum_u_w + width_, 0.0f);
  for (int k = 1; k <= radius_; ++k)
  {
    const float* left = inverse - k;
    const float* right = inverse + k;
    const auto du = static_cast<float>(k);
    for (int u = 0; u < width_; ++u)
    {
      sum_w[u] += left[u] + right[u];
      sum_u_w[u] += du * (right[u] - left[u]);
    }
  }
}

void WholeWindowFit::row(int v, const std::uint8_t* marked, cv::Vec3f* normals)
{
  for (; next_row_ <= v + radius_; ++next_row_)
    horizontalSums(next_row_);
  std::copy(sums(&sum_w_, v), sums(&sum_w_, v) + width_, total_w_.begin());
  std::copy(sums(&sum_u_w_, v), sums(&sum_u_w_, v) + width_, total_u_w_.begin());
  std::fill(total_v_w_.begin(), total_v_w_.end(), 0.0f);
  for (int k = 1; k <= radius_; ++k)
  {
    const float* above = sums(&sum_w_, v - k);
    const float* below = sums(&sum_w_, v + k);
    const float* above_u = sums(&sum_u_w_, v - k);
    const float* below_u = sums(&sum_u_w_, v + k);
    const auto dv = static_cast<float>(k);
    for (int u = 0; u < width_; ++u)
    {
      total_w_[u] += above[u] + below[u];
      total_u_w_[u] += above_u[u] + below_u[u];
      total_v_w_[u] += dv * (below[u] - above[u]);
    }
  }
  // sum of du^2 over the window: window * 2 (1 + 4 + ... + r^2)
  const float per_squares = 3.0f / static_cast<float>(window_ * radius_ * (radius_ + 1) * window_);
  const float per_count = 1.0f / static_cast<float>(window_ * window_);
  for (int u = 0; u < width_; ++u)
    if (marked[u])
      normals[u] =
          normalOf(camera_, u, v, total_u_w_[u] * per_squares, total_v_w_[u] * per_squares, total_w_[u] * per_count);
}

GatedWindowFit::GatedWindowFit(const PaddedDepth& padded, const geometry::PinholeCamera& camera,
                               const NormalOptions& options)
    : padded_(padded),
      camera_(camera),
      step_ratio_(static_cast<float>(options.max_depth_step_ratio)),
      min_count_(static_cast<float>(options.min_neighbors + 1))
{
}

GatedWindowFit::Moments GatedWindowFit::sums(int v, int u) const
{
  using Lanes = cv::v_float32x4;
  const int radius = padded_.radius();
  // Depth images are smooth over two pixels: in larger windows every other pixel, as on a chessboard, does as well.
  const int step = radius >= 3 ? 2 : 1;
  const Lanes depth = cv::v_load(padded_.depthRow(v) + u);
  const Lanes inverse = cv::v_load(padded_.inverseRow(v) + u);
  const Lanes gate = depth * cv::v_setall_f32(step_ratio_);
  const Lanes one = cv::v_setall_f32(1.0f);
  const Lanes zero = cv::v_setzero_f32();
  Lanes n = zero, u_sum = zero, v_sum = zero, uu = zero, uv = zero, vv = zero, w = zero, uw = zero, vw = zero;
  for (int dv = -radius; dv <= radius; ++dv)
  {
    const float* z_row = padded_.depthRow(v + dv) + u;
    const float* w_row = padded_.inverseRow(v + dv) + u;
    Lanes row_n = zero, row_u = zero, row_uu = zero, row_w = zero, row_uw = zero;
    const int first = -radius + (step == 2 ? (radius + dv) & 1 : 0);
    for (int du = first; du <= radius; du += step)
    {
      const Lanes inside = cv::v_abs(cv::v_load(z_row + du) - depth) <= gate;
      const Lanes count = inside & one;
      const Lanes dw = inside & (cv::v_load(w_row + du) - inverse);
      const Lanes x = cv::v_setall_f32(static_cast<float>(du));
      const Lanes count_x = count * x;
      row_n += count;
      row_u += count_x;
      row_uu += count_x * x;
      row_w += dw;
      row_uw += dw * x;
    }
    const Lanes y = cv::v_setall_f32(static_cast<float>(dv));
    n += row_n;
    u_sum += row_u;
    v_sum += row_n * y;
    uu += row_uu;
    uv += row_u * y;
    vv += row_n * y * y;
    w += row_w;
    uw += row_uw;
    vw += row_w * y;
  }
  Moments moments;
  cv::v_store(moments.n, n);
  cv::v_store(moments.u, u_sum);
  cv::v_store(moments.v, v_sum);
  cv::v_store(moments.uu, uu);
  cv::v_store(moments.uv, uv);
  cv::v_store(moments.vv, vv);
  cv::v_store(moments.w, w);
  cv::v_store(moments.uw, uw);
  cv::v_store(moments.vw, vw);
  return moments;
}

void GatedWindowFit::solve(const Moments& moments, int lane, int u, int v, cv::Vec3f* normal) const
{
  const float n = moments.n[lane];
  if (n < min_count_)
    return;
  const float per_n = 1.0f / n;
  const float mean_u = moments.u[lane] * per_n;
  const float mean_v = moments.v[lane] * per_n;
  const float mean_w = moments.w[lane] * per_n;
  const float c_uu = moments.uu[lane] * per_n - mean_u * mean_u;
  const float c_uv = moments.uv[lane] * per_n - mean_u * mean_v;
  const float c_vv = moments.vv[lane] * per_n - mean_v * mean_v;
  const float c_uw = moments.uw[lane] * per_n - mean_u * mean_w;
  const float c_vw = moments.vw[lane] * per_n - mean_v * mean_w;
  const float determinant = c_uu * c_vv - c_uv * c_uv;
  // Pixels of one line leave the plane free to turn about it.
  if (determinant < 0.02f * (c_uu + c_vv) * (c_uu + c_vv))
    return;
  const float per_determinant = 1.0f / determinant;
  const float a = (c_uw * c_vv - c_vw * c_uv) * per_determinant;
  const float b = (c_vw * c_uu - c_uw * c_uv) * per_determinant;
  *normal = normalOf(camera_, u, v, a, b, padded_.inverseRow(v)[u] + mean_w - a * mean_u - b * mean_v);
}

void GatedWindowFit::row(int v, const std::uint8_t* marked, cv::Vec3f* normals) const
{
  const float* depth = padded_.depthRow(v);
  const int width = padded_.size().width;
  const auto wanted = [&](int u) { return !marked[u] && depth[u] > 0; };
  for (int u = 0; u < width; ++u)
  {
    if (!wanted(u))
      continue;
    const Moments moments = sums(v, u);
    for (int lane = 0; lane < LANES && u + lane < width; ++lane)
      if (wanted(u + lane))
        solve(moments, lane, u + lane, v, &normals[u + lane]);
    u += LANES - 1;
  }
}

}  // namespace object_modelling::rgbd
