#include "object_modelling/segmentation/smooth_clustering.h"

#include <algorithm>
#include <cmath>

#include "noise_table.h"
#include "object_modelling/base/disjoint_sets.h"

namespace object_modelling::segmentation
{
namespace
{
constexpr int MAX_GAP_PX = 2;
constexpr int MIN_NEIGHBORS = 3;
constexpr int MAX_FOOT_PX = 5;

bool connected(float z_a, float z_b, float ratio)
{
  return std::abs(z_a - z_b) <= ratio * std::min(z_a, z_b);  // false for NaN
}

bool flying(const cv::Mat& depth_m, int u, int v, float ratio)
{
  const float z = depth_m.at<float>(v, u);
  int neighbors = 0;
  for (int y = std::max(0, v - 1); y <= std::min(depth_m.rows - 1, v + 1); ++y)
    for (int x = std::max(0, u - 1); x <= std::min(depth_m.cols - 1, u + 1); ++x)
      neighbors += connected(z, depth_m.at<float>(y, x), ratio);
  return neighbors - 1 < MIN_NEIGHBORS;  // the pixel has counted itself
}

/// Labels of the HIGH pixels spread over LOW ones, a few pixels far: the last millimetres above the support.
void growFeet(const cv::Mat& depth_m, const cv::Mat& foreground, float ratio, cv::Mat* labels)
{
  std::vector<cv::Point> front, next;
  for (int v = 0; v < foreground.rows; ++v)
    for (int u = 0; u < foreground.cols; ++u)
      if (labels->at<int>(v, u) != 0)
        front.emplace_back(u, v);
  const cv::Rect image(0, 0, foreground.cols, foreground.rows);
  for (int step = 0; step < MAX_FOOT_PX && !front.empty(); ++step)
  {
    next.clear();
    for (const cv::Point& from : front)
      for (const cv::Point& way : { cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1) })
      {
        const cv::Point to = from + way;
        if (!image.contains(to) || labels->at<int>(to) != 0 || foreground.at<std::uint8_t>(to) != LOW ||
            !connected(depth_m.at<float>(from), depth_m.at<float>(to), ratio))
          continue;
        labels->at<int>(to) = labels->at<int>(from);
        next.push_back(to);
      }
    front.swap(next);
  }
}

/// Labels of the HIGH pixels, 0 elsewhere: equal, or of one set, where pixels are connected.
cv::Mat connectHigh(const cv::Mat& depth_m, const cv::Mat& foreground, float ratio, base::DisjointSets* sets)
{
  cv::Mat labels = cv::Mat::zeros(foreground.size(), CV_32SC1);
  for (int v = 0; v < foreground.rows; ++v)
  {
    const auto* on = foreground.ptr<std::uint8_t>(v);
    for (int u = 0; u < foreground.cols; ++u)
    {
      if (on[u] != HIGH)
        continue;
      const float z = depth_m.at<float>(v, u);
      int label = 0;
      const auto joinWith = [&](int x, int y)
      {
        const int other = labels.at<int>(y, x);
        if (other == 0 || !connected(z, depth_m.at<float>(y, x), ratio))
          return;
        if (label == 0)
          label = other;
        else
          sets->unite(label, other);
      };
      // The nearest pixel with depth to the left and above, and the diagonal neighbours.
      for (int gap = 1; gap <= MAX_GAP_PX + 1 && u - gap >= 0; ++gap)
        if (std::isfinite(depth_m.at<float>(v, u - gap)))
        {
          joinWith(u - gap, v);
          break;
        }
      for (int gap = 1; gap <= MAX_GAP_PX + 1 && v - gap >= 0; ++gap)
        if (std::isfinite(depth_m.at<float>(v - gap, u)))
        {
          joinWith(u, v - gap);
          break;
        }
      if (v > 0 && u > 0)
        joinWith(u - 1, v - 1);
      if (v > 0 && u + 1 < foreground.cols)
        joinWith(u + 1, v - 1);
      labels.at<int>(v, u) = label != 0 ? label : static_cast<int>(sets->add());
    }
  }
  return labels;
}

/// Gives the pixels of a set one label, and the clusters of at least `min_pixels` of them.
std::vector<Cluster> clustersOf(base::DisjointSets& sets, int min_pixels, cv::Mat* labels)
{
  struct Extent
  {
    int count = 0, left = 0, right = 0, top = 0, bottom = 0;
  };
  std::vector<Extent> extents(sets.size());
  for (int v = 0; v < labels->rows; ++v)
  {
    auto* row = labels->ptr<int>(v);
    for (int u = 0; u < labels->cols; ++u)
    {
      if (row[u] == 0)
        continue;
      row[u] = static_cast<int>(sets.find(row[u]));
      Extent& extent = extents[row[u]];
      if (extent.count++ == 0)
        extent = { 1, u, u, v, v };
      extent.left = std::min(extent.left, u);
      extent.right = std::max(extent.right, u);
      extent.bottom = v;
    }
  }
  std::vector<Cluster> clusters;
  for (int label = 1; label < static_cast<int>(sets.size()); ++label)
  {
    const Extent& e = extents[label];
    if (e.count >= min_pixels)
      clusters.push_back({ label, e.count, cv::Rect(e.left, e.top, e.right - e.left + 1, e.bottom - e.top + 1) });
  }
  return clusters;
}
}  // namespace

cv::Mat pixelsAbove(const rgbd::Frame& frame, const geometry::Plane& plane_camera, const HeightLimits& limits,
                    double depth_step_ratio, const cv::Rect& area)
{
  const std::shared_ptr<const NoiseTable> table = NoiseTable::of(frame.noise_model);
  const NoiseTable& noise = *table;
  const cv::Rect image(0, 0, frame.depth_m.cols, frame.depth_m.rows);
  const cv::Rect rect = area.area() > 0 ? area & image : image;
  const auto n = plane_camera.normal.cast<float>().eval();
  const auto offset_m = static_cast<float>(plane_camera.offset_m);
  const auto min_m = static_cast<float>(limits.min_m), max_m = static_cast<float>(limits.max_m);
  const auto sigmas = static_cast<float>(limits.noise_sigmas);
  const auto max_z_m = static_cast<float>(limits.max_distance_m);
  const auto ratio = static_cast<float>(depth_step_ratio);
  const auto inverse_fx = static_cast<float>(1 / frame.camera.fx), inverse_fy = static_cast<float>(1 / frame.camera.fy);

  cv::Mat above = cv::Mat::zeros(image.size(), CV_8UC1);
  for (int v = rect.y; v < rect.y + rect.height; ++v)
  {
    const auto* depth_m = frame.depth_m.ptr<float>(v);
    auto* out = above.ptr<std::uint8_t>(v);
    const float y = (v - static_cast<float>(frame.camera.cy)) * inverse_fy;
    for (int u = rect.x; u < rect.x + rect.width; ++u)
    {
      const float z = depth_m[u];
      if (!(z <= max_z_m))
        continue;
      const float x = (u - static_cast<float>(frame.camera.cx)) * inverse_fx;
      const float along_normal = n.x() * x + n.y() * y + n.z();  // height gained per metre of depth
      const float height_m = z * along_normal + offset_m;
      if (height_m <= min_m / 2 || height_m > max_m)
        continue;
      const float projection = std::abs(along_normal);
      const float sigma_m = projection * noise.sigma_m(z, projection / std::sqrt(x * x + y * y + 1));
      const float limit_m = min_m + sigmas * sigma_m;
      if (height_m > limit_m / 2 && !flying(frame.depth_m, u, v, ratio))
        out[u] = height_m > limit_m ? HIGH : LOW;
    }
  }
  return above;
}

cv::Mat Clusters::mask(const Cluster& cluster) const
{
  cv::Mat result = cv::Mat::zeros(labels.size(), CV_8UC1);
  for (int v = cluster.rect.y; v < cluster.rect.y + cluster.rect.height; ++v)
  {
    const auto* from = labels.ptr<int>(v);
    auto* to = result.ptr<std::uint8_t>(v);
    for (int u = cluster.rect.x; u < cluster.rect.x + cluster.rect.width; ++u)
      if (from[u] == cluster.label)
        to[u] = 255;
  }
  return result;
}

Clusters clusterSmooth(const rgbd::Frame& frame, const cv::Mat& foreground, double depth_step_ratio, int min_pixels)
{
  const auto ratio = static_cast<float>(depth_step_ratio);
  base::DisjointSets sets(1);  // 0 is the background
  Clusters result;
  result.labels = connectHigh(frame.depth_m, foreground, ratio, &sets);
  growFeet(frame.depth_m, foreground, ratio, &result.labels);
  result.clusters = clustersOf(sets, min_pixels, &result.labels);
  std::stable_sort(result.clusters.begin(), result.clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.pixel_count > b.pixel_count; });
  return result;
}

}  // namespace object_modelling::segmentation
