#include "object_modelling/registration/dense_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "object_modelling/rgbd/normals.h"

namespace object_modelling::registration
{
namespace
{
constexpr int MAX_FINEST_WIDTH = 200;  // px: VGA and its neighbours begin at a quarter
constexpr std::size_t LEVEL_COUNT = 3;
constexpr float SURFACE_STEP_RATIO = 0.015F;   // of depth per pixel of the finer level
constexpr double MIN_GRADIENT = 6;             // grey levels per pixel
constexpr std::size_t MAX_GRID_POINTS = 1200;  // per level: more of them add no information ...
constexpr std::size_t MAX_EDGE_POINTS = 1200;  // ... for neighbours err alike

/// Every second pixel of `depth_m` (or every step-th), averaged with those neighbours that lie on the same surface.
cv::Mat reduceDepth(const cv::Mat& depth_m, int step, cv::Size size)
{
  cv::Mat reduced(size, CV_32FC1);
  for (int v = 0; v < size.height; ++v)
  {
    const int y = v * step;
    const float* rows[3] = { depth_m.ptr<float>(std::max(0, y - 1)), depth_m.ptr<float>(y),
                             depth_m.ptr<float>(std::min(depth_m.rows - 1, y + 1)) };
    auto* out = reduced.ptr<float>(v);
    for (int u = 0; u < size.width; ++u)
    {
      const int x = std::clamp(u * step, 1, depth_m.cols - 2);
      const float center = rows[1][x];
      const float gate = SURFACE_STEP_RATIO * center;
      float sum = 0;
      float count = 0;
      // Opposite neighbours go together, so that the mean of a slanted surface stays in place. NaN fails the test.
      const auto add = [&](float a, float b)
      {
        if (std::abs(a - center) <= gate && std::abs(b - center) <= gate)
        {
          sum += a + b;
          count += 2;
        }
      };
      add(rows[0][x - 1], rows[2][x + 1]);
      add(rows[0][x], rows[2][x]);
      add(rows[0][x + 1], rows[2][x - 1]);
      add(rows[1][x - 1], rows[1][x + 1]);
      out[u] = count > 0 ? (sum + center) / (count + 1) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return reduced;
}

rgbd::Frame asFrame(const DenseLevel& level)
{
  rgbd::Frame frame;
  frame.depth_m = level.depth_m;
  frame.camera.width = level.depth_m.cols;
  frame.camera.height = level.depth_m.rows;
  frame.camera.fx = level.fx;
  frame.camera.fy = level.fy;
  frame.camera.cx = level.cx;
  frame.camera.cy = level.cy;
  return frame;
}

double gradientAt(const cv::Mat& gray, int u, int v)
{
  const auto* row = gray.ptr<std::uint8_t>(v) + u;
  return 0.5 * std::hypot(row[1] - row[-1], row[gray.step] - row[-static_cast<std::ptrdiff_t>(gray.step)]);
}

/// How many points in the order of the image there are for one that is taken.
int stride(std::size_t count, std::size_t wanted)
{
  return static_cast<int>((count + wanted - 1) / wanted);
}

DensePoints referencePoints(const DenseLevel& level)
{
  rgbd::NormalOptions normal_options;
  normal_options.radius_px = 2;
  normal_options.max_depth_step_ratio = 0.04;
  const cv::Mat normals = rgbd::computeNormals(asFrame(level), normal_options);
  cv::Mat valid = level.depth_m == level.depth_m;  // false for NaN
  if (!level.mask.empty())
    valid.setTo(0, level.mask == 0);
  cv::Mat edges(level.gray.size(), CV_8UC1, cv::Scalar(0));
  for (int v = 1; v < edges.rows - 1; ++v)
    for (int u = 1; u < edges.cols - 1; ++u)
      edges.at<std::uint8_t>(v, u) = valid.at<std::uint8_t>(v, u) != 0 && gradientAt(level.gray, u, v) >= MIN_GRADIENT;
  const int every_edge = std::max(1, stride(static_cast<std::size_t>(cv::countNonZero(edges)), MAX_EDGE_POINTS));
  const int grid = std::max(1, stride(static_cast<std::size_t>(cv::countNonZero(valid)), MAX_GRID_POINTS));
  const int shear = grid / 3 + 1;  // from row to row, so that the grid is about as wide as high
  DensePoints points;
  points.pixels_per_point = grid;
  points.edges_per_point = every_edge;
  int edge = 0;
  for (int v = 1; v < level.depth_m.rows - 1; ++v)
  {
    const auto* depth = level.depth_m.ptr<float>(v);
    const auto* normal = normals.ptr<cv::Vec3f>(v);
    const auto* is_edge = edges.ptr<std::uint8_t>(v);
    const auto* is_valid = valid.ptr<std::uint8_t>(v);
    for (int u = 1; u < level.depth_m.cols - 1; ++u)
    {
      if (is_valid[u] == 0)
        continue;
      DensePoint point;
      point.textured = is_edge[u] != 0 && edge++ % every_edge == 0;
      const bool on_grid = (u + v * shear) % grid == 0;
      if (!point.textured && !on_grid)
        continue;
      point.p = { (static_cast<float>(u) - level.cx) / level.fx * depth[u],
                  (static_cast<float>(v) - level.cy) / level.fy * depth[u], depth[u] };
      point.n.setZero();
      if (on_grid && !std::isnan(normal[u][0]))
        point.n = { normal[u][0], normal[u][1], normal[u][2] };
      point.intensity = level.gray.at<std::uint8_t>(v, u);
      points.all.push_back(point);
    }
  }
  return points;
}
}  // namespace

DensePyramid::DensePyramid(const rgbd::Frame& frame, const std::vector<cv::Mat>& gray_levels)
{
  std::size_t first = 0;
  while (first + 1 < gray_levels.size() && gray_levels[first].cols > MAX_FINEST_WIDTH)
    ++first;
  for (std::size_t i = first; i < std::min(gray_levels.size(), first + LEVEL_COUNT); ++i)
  {
    DenseLevel level;
    level.step = 1 << i;
    const auto scale = 1.0F / static_cast<float>(level.step);
    level.fx = static_cast<float>(frame.camera.fx) * scale;
    level.fy = static_cast<float>(frame.camera.fy) * scale;
    level.cx = static_cast<float>(frame.camera.cx) * scale;
    level.cy = static_cast<float>(frame.camera.cy) * scale;
    level.noise_model = frame.noise_model;
    level.gray = gray_levels[i];
    level.depth_m = levels_.empty() ? reduceDepth(frame.depth_m, level.step, level.gray.size())
                                    : reduceDepth(levels_.back().depth_m, 2, level.gray.size());
    if (!frame.object_mask.empty())
      cv::resize(frame.object_mask, level.mask, level.gray.size(), 0, 0, cv::INTER_NEAREST);
    levels_.push_back(level);
  }
}

DenseReference::DenseReference(const DensePyramid& pyramid)
{
  for (const DenseLevel& level : pyramid.levels())
  {
    levels_.push_back(referencePoints(level));
    const double coarse = level.step / static_cast<double>(pyramid.levels().front().step);
    levels_.back().pixels_per_point *= coarse * coarse;
  }
}

}  // namespace object_modelling::registration
