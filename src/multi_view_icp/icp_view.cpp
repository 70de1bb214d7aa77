#include "icp_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "object_modelling/rgbd/color_shift.h"
#include "object_modelling/rgbd/depth_edges.h"
#include "object_modelling/rgbd/normals.h"
#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr int MAX_WIDTH_PX = 320;
constexpr float SURFACE_STEP_RATIO = 0.015F;      // of depth, among four neighbours of one surface
constexpr float SYSTEMATIC_DEPTH_RATIO = 0.001F;  // of depth: calibration, which averaging does not remove
constexpr float AVERAGED_NOISE = 0.7F;            // of four readings, whose errors are alike
constexpr float MIN_FACING_COSINE = 0.2F;
constexpr int BUCKETS = 8;         // of normals, each way
constexpr float MIN_GRADIENT = 6;  // grey levels per pixel
constexpr int NORMAL_RADIUS_PX = 2;
constexpr int RIM_POINTS = 400;
constexpr int RIM_WINDOW_PX = 9;  // sensors have no depth beside a step
constexpr float RIM_STEP_RATIO = 0.03F;

/// Mean depth of two by two pixels where they are one surface; NaN elsewhere, which is at every depth edge.
cv::Mat halved(const cv::Mat& depth_m)
{
  cv::Mat half(depth_m.rows / 2, depth_m.cols / 2, CV_32FC1);
  for (int v = 0; v < half.rows; ++v)
  {
    const auto* upper = depth_m.ptr<float>(2 * v);
    const auto* lower = depth_m.ptr<float>(2 * v + 1);
    auto* out = half.ptr<float>(v);
    for (int u = 0; u < half.cols; ++u)
    {
      const std::array<float, 4> z = { upper[2 * u], upper[2 * u + 1], lower[2 * u], lower[2 * u + 1] };
      const float mean = 0.25F * (z[0] + z[1] + z[2] + z[3]);
      const auto [low, high] = std::minmax_element(z.begin(), z.end());
      out[u] = *high - *low <= SURFACE_STEP_RATIO * mean ? mean : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return half;
}

float gradientAt(const cv::Mat& gray, int u, int v)
{
  if (u < 1 || v < 1 || u + 1 >= gray.cols || v + 1 >= gray.rows)
    return 0;
  const auto across = static_cast<float>(gray.at<std::uint8_t>(v, u + 1) - gray.at<std::uint8_t>(v, u - 1));
  const auto down = static_cast<float>(gray.at<std::uint8_t>(v + 1, u) - gray.at<std::uint8_t>(v - 1, u));
  return 0.5F * std::hypot(across, down);
}

/// `wanted` of the pixels, the same number from each bucket as far as they have them.
std::vector<cv::Point> evenly(const std::vector<std::vector<cv::Point>>& buckets, int wanted)
{
  std::vector<std::size_t> sizes;
  for (const auto& bucket : buckets)
    if (!bucket.empty())
      sizes.push_back(bucket.size());
  std::sort(sizes.begin(), sizes.end());
  auto left = static_cast<std::size_t>(wanted);
  std::size_t quota = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    quota = std::max<std::size_t>(1, left / (sizes.size() - i));
    left -= std::min(left, std::min(quota, sizes[i]));
  }
  std::vector<cv::Point> chosen;
  for (const auto& bucket : buckets)
  {
    const std::size_t count = std::min(bucket.size(), quota);
    for (std::size_t i = 0; i < count; ++i)
      chosen.push_back(bucket[(2 * i + 1) * bucket.size() / (2 * count)]);
  }
  return chosen;
}

/// Which direction a normal has, of those towards the camera.
int bucketOf(const Eigen::Vector3f& n)
{
  const auto cell = [](float component)
  { return std::clamp(static_cast<int>(0.5F * (component + 1) * BUCKETS), 0, BUCKETS - 1); };
  return cell(n.x()) + BUCKETS * cell(n.y());
}
}  // namespace

float IcpView::surfaceSigma_m(const Eigen::Vector3f& p, const Eigen::Vector3f& n) const
{
  const float cosine = std::max(MIN_FACING_COSINE, -n.dot(p.normalized()));
  const auto noise_m =
      AVERAGED_NOISE * static_cast<float>(noise_model_.axialSigma_m(p.z(), std::acos(std::min(1.0F, cosine))));
  const float systematic_m = SYSTEMATIC_DEPTH_RATIO * p.z();
  return cosine * std::sqrt(noise_m * noise_m + systematic_m * systematic_m);
}

IcpView::IcpView(const rgbd::View& view, const MultiViewIcpOptions& options)
{
  const rgbd::Frame& frame = view.frame;
  noise_model_ = frame.noise_model;
  rgbd::Frame reduced;
  reduced.camera = frame.camera;
  reduced.depth_m = frame.depth_m;
  cv::Mat gray;
  if (options.color_weight > 0 && frame.gray.size() == frame.depth_m.size())
    gray = rgbd::ontoDepth(frame.gray, view.color_offset_px);
  while (reduced.depth_m.cols > MAX_WIDTH_PX)
  {
    reduced.depth_m = halved(reduced.depth_m);
    reduced.camera = reduced.camera.scaled(0.5);
    if (!gray.empty())
      cv::resize(gray, gray, reduced.depth_m.size(), 0, 0, cv::INTER_AREA);
  }
  depth_m_ = reduced.depth_m;
  camera_ = reduced.camera;
  camera_.width = depth_m_.cols;  // none without depth
  camera_.height = depth_m_.rows;
  fx_cx_ = { static_cast<float>(reduced.camera.fx), static_cast<float>(reduced.camera.cx) };
  fy_cy_ = { static_cast<float>(reduced.camera.fy), static_cast<float>(reduced.camera.cy) };
  if (depth_m_.empty())
    return;
  rgbd::NormalOptions normal_options;
  normal_options.radius_px = NORMAL_RADIUS_PX;
  normals_ = rgbd::computeNormals(reduced, normal_options);
  const cv::Mat from_edge_px = rgbd::distanceToEdges_px(rgbd::findDepthEdges(reduced));
  usable_ = from_edge_px >= options.min_edge_distance_px;
  cv::Mat mask(usable_.size(), CV_8UC1, cv::Scalar(options.object_only ? 0 : 255));
  if (options.object_only)
  {
    if (!frame.object_mask.empty())
      cv::resize(frame.object_mask, mask, usable_.size(), 0, 0, cv::INTER_NEAREST);
    usable_ &= mask;
  }
  for (int v = 0; v < usable_.rows; ++v)
    for (int u = 0; u < usable_.cols; ++u)
      if (has(u, v) && !(depth_m(u, v) > 0 && normal(u, v).dot(point(u, v).normalized()) < -MIN_FACING_COSINE))
        usable_.at<std::uint8_t>(v, u) = 0;
  geometry::PinholeCamera camera = reduced.camera;
  for (int level = 0; level < ICP_COLOR_LEVELS && !gray.empty(); ++level)
  {
    if (level > 0)
    {
      cv::resize(gray, gray, gray.size() / 2, 0, 0, cv::INTER_AREA);
      camera = camera.scaled(0.5);
    }
    images_.push_back({ gray.clone(), static_cast<float>(camera.fx), static_cast<float>(camera.fy),
                        static_cast<float>(camera.cx), static_cast<float>(camera.cy) });
  }
  choosePoints(options.points_per_keyframe);
  chooseRims(mask);
}

void IcpView::chooseRims(const cv::Mat& mask)
{
  cv::Mat known = depth_m_.clone();
  known.setTo(0, depth_m_ != depth_m_);
  cv::Mat farthest, nearest;
  cv::dilate(known, farthest, cv::Mat::ones(RIM_WINDOW_PX, RIM_WINDOW_PX, CV_8UC1));
  cv::erode(known, nearest, cv::Mat());  // 0 next to pixels without depth
  std::vector<std::vector<cv::Point>> rims(1);
  for (int v = 0; v < known.rows; ++v)
  {
    for (int u = 0; u < known.cols; ++u)
    {
      const float z = known.at<float>(v, u);
      if (mask.at<std::uint8_t>(v, u) != 0 && z > 0 && farthest.at<float>(v, u) > (1 + RIM_STEP_RATIO) * z &&
          (nearest.at<float>(v, u) == 0 || usable_.at<std::uint8_t>(v, u) == 0))
        rims.front().emplace_back(u, v);
    }
  }
  for (const cv::Point& pixel : evenly(rims, RIM_POINTS))
    rim_points_.push_back(point(pixel.x, pixel.y));
}

IcpPoint IcpView::pointAt(int u, int v) const
{
  IcpPoint chosen;
  chosen.p = point(u, v);
  chosen.n = normal(u, v);
  chosen.sigma_m = surfaceSigma_m(chosen.p, chosen.n);
  for (std::size_t level = 0; level < images_.size(); ++level)
  {
    const IcpImage& image = images_[level];
    const float x = image.fx * chosen.p.x() / chosen.p.z() + image.cx;
    const float y = image.fy * chosen.p.y() / chosen.p.z() + image.cy;
    cv::Mat patch;
    cv::getRectSubPix(image.gray, { 1, 1 }, { x, y }, patch, CV_32F);
    chosen.intensity[static_cast<int>(level)] = patch.at<float>(0);
  }
  return chosen;
}

void IcpView::choosePoints(int count)
{
  std::vector<std::vector<cv::Point>> by_normal(BUCKETS * BUCKETS), edges(1);
  for (int v = 0; v < usable_.rows; ++v)
  {
    for (int u = 0; u < usable_.cols; ++u)
    {
      if (!has(u, v))
        continue;
      by_normal[bucketOf(normal(u, v))].emplace_back(u, v);
      if (!images_.empty() && gradientAt(images_.front().gray, u, v) >= MIN_GRADIENT)
        edges.front().emplace_back(u, v);
    }
  }
  for (const cv::Point& pixel : evenly(by_normal, count))
    surface_points_.push_back(pointAt(pixel.x, pixel.y));
  for (const cv::Point& pixel : evenly(edges, count))
    color_points_.push_back(pointAt(pixel.x, pixel.y));
}

}  // namespace object_modelling::multi_view_icp
