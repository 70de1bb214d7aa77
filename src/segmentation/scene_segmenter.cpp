#include "object_modelling/segmentation/scene_segmenter.h"

#include <algorithm>
#include <cmath>

#include "low_holes.h"
#include "noise_table.h"
#include "object_modelling/base/options.h"
#include "plane_growing.h"
#include "object_modelling/segmentation/smooth_clustering.h"
#include "support_choice.h"
#include "support_extent.h"

namespace object_modelling::segmentation
{
namespace
{
constexpr std::size_t MAX_SUPPORTS_TRIED = 3;
constexpr double EXTENT_MARGIN_M = 0.02;
constexpr double MIN_CARRIED_RATIO = 0.5;

/// The grown planes at full resolution: all pixels that lie in a plane, next to working pixels that grew into it.
std::vector<SupportedPlane> fullPlanes(const rgbd::Frame& frame, const WorkingImage& image, const GrownPlanes& planes,
                                       double distance_sigmas)
{
  const std::shared_ptr<const NoiseTable> noise = NoiseTable::of(frame.noise_model);
  const auto sigmas = static_cast<float>(distance_sigmas);
  std::vector<SupportedPlane> result;
  std::vector<Eigen::Vector4f> coefficients;
  for (const GrownPlane& grown : planes.planes)
  {
    result.push_back({ grown.plane, 0, cv::Mat::zeros(frame.depth_m.size(), CV_8UC1) });
    coefficients.emplace_back();
    coefficients.back() << grown.plane.normal.cast<float>(), static_cast<float>(grown.plane.offset_m);
  }
  for (int v = 0; v < frame.depth_m.rows; ++v)
  {
    const auto* grown = planes.labels.ptr<std::int16_t>(v / image.step);
    for (int u = 0; u < frame.depth_m.cols; ++u)
    {
      const int index = grown[u / image.step];
      if (index < 0)
        continue;
      const Eigen::Vector3f p = frame.point(u, v);
      const Eigen::Vector4f& plane = coefficients[index];
      const Eigen::Vector3f n = plane.head<3>();
      const float limit_m = sigmas * static_cast<float>(planes.planes[index].noise_scale) * noise->sigmaAlong_m(n, p);
      if (!(std::abs(n.dot(p) + plane[3]) <= limit_m))
        continue;
      result[index].mask.at<std::uint8_t>(v, u) = 255;
      ++result[index].pixel_count;
    }
  }
  return result;
}

Hypothesis describe(const rgbd::Frame& frame, const geometry::Plane& support, const cv::Mat& mask, const cv::Rect& rect)
{
  constexpr int SAMPLES = 2000;
  constexpr double TRIM_RATIO = 0.002;
  Hypothesis hypothesis;
  hypothesis.mask = mask;
  hypothesis.pixel_count = cv::countNonZero(mask(rect));
  const int stride = std::max(1, hypothesis.pixel_count / SAMPLES);
  std::vector<Eigen::Vector3f> points;
  int index = 0;
  for (int v = rect.y; v < rect.y + rect.height; ++v)
    for (int u = rect.x; u < rect.x + rect.width; ++u)
      if (mask.at<std::uint8_t>(v, u) != 0 && index++ % stride == 0)
      {
        points.push_back(frame.point(u, v));
        hypothesis.centroid_camera += points.back().cast<double>();
      }
  hypothesis.centroid_camera /= static_cast<double>(points.size());

  // The box reaches down to the support, which hides the object's lowest part.
  geometry::OrientedBox& box = hypothesis.box_camera;
  box = geometry::boxAlong(support.normal, points, TRIM_RATIO);
  const double top_m = support.signedDistance_m(box.T_frame_box.translation()) + box.size_m.z() / 2;
  box.T_frame_box.pretranslate((top_m / 2 - (top_m - box.size_m.z() / 2)) * support.normal);
  box.size_m.z() = top_m;
  return hypothesis;
}

std::vector<Hypothesis> findHypotheses(const rgbd::Frame& frame, const WorkingImage& image, const GrownPlanes& planes,
                                       int support, const SceneSegmenterOptions& options)
{
  const geometry::Plane& plane = planes.planes[support].plane;
  const HeightLimits limits{ options.min_height_m, options.height_noise_sigmas * planes.planes[support].noise_scale,
                             options.max_height_m, options.max_distance_m };
  const double area_ratio = frame.depth_m.total() / (640.0 * 480.0);
  const int min_pixels = std::max(1, static_cast<int>(std::lround(options.min_cluster_px * area_ratio)));
  const cv::Mat above = pixelsAbove(frame, plane, limits, options.cluster_depth_step_ratio);
  const Clusters clusters = clusterSmooth(frame, above, options.cluster_depth_step_ratio, min_pixels);
  const SupportExtent extent(image, planes, support);

  std::vector<Hypothesis> hypotheses;
  for (const Cluster& cluster : clusters.clusters)
  {
    cv::Mat mask = clusters.mask(cluster);
    if (extent.carriedRatio(frame, mask, cluster.rect, EXTENT_MARGIN_M) < MIN_CARRIED_RATIO)
      continue;
    fillLowHoles(frame, plane, options.min_height_m * planes.planes[support].noise_scale, options.max_height_m,
                 cluster.rect, &mask);
    hypotheses.push_back(describe(frame, plane, mask, cluster.rect));
    hypotheses.back().id = static_cast<int>(hypotheses.size()) - 1;
  }
  return hypotheses;
}

/// A plane above the chosen one that carries something and is large beside it: turntable, tray, place mat.
int pedestalOn(int support, const std::vector<int>& ranked, const GrownPlanes& planes, const rgbd::Frame& frame,
               const WorkingImage& image, const SceneSegmenterOptions& options, std::vector<Hypothesis>* hypotheses)
{
  constexpr double MIN_IMAGE_RATIO = 0.08;
  constexpr double MIN_RATIO_TO_CARRIED = 1.5;
  const auto image_pixels = static_cast<double>(image.frame.depth_m.total());
  for (const int candidate : ranked)
  {
    const GrownPlane& plane = planes.planes[candidate];
    if (candidate == support || !liesAbove(plane, planes.planes[support]) ||
        plane.moments.count < MIN_IMAGE_RATIO * image_pixels)
      continue;
    std::vector<Hypothesis> carried = findHypotheses(frame, image, planes, candidate, options);
    const double working_pixels = plane.moments.count * static_cast<double>(image.step * image.step);
    if (carried.empty() || working_pixels < MIN_RATIO_TO_CARRIED * carried.front().pixel_count)
      continue;
    *hypotheses = std::move(carried);
    return candidate;
  }
  return support;
}

}  // namespace

std::vector<std::string> SceneSegmenterOptions::violations() const
{
  base::OptionsCheck check("segmenter");
  check.inRange("plane_angle_rad", plane_angle_rad, 0.01, 0.7);
  check.inRange("plane_distance_sigmas", plane_distance_sigmas, 0.5, 20.0);
  check.inRange("min_plane_ratio", min_plane_ratio, 0.0005, 1.0);
  check.inRange("min_height_m", min_height_m, 0.0, 0.5);
  check.inRange("height_noise_sigmas", height_noise_sigmas, 0.0, 10.0);
  check.require("max_height_m", max_height_m > min_height_m, "must be greater than min_height_m");
  check.positive("max_distance_m", max_distance_m);
  check.inRange("cluster_depth_step_ratio", cluster_depth_step_ratio, 0.001, 0.2);
  check.atLeast("min_cluster_px", min_cluster_px, 1);
  return check.violations();
}

SceneSegmenter::SceneSegmenter(const SceneSegmenterOptions& options) : options_(base::checked(options))
{
}

SceneSegmentation SceneSegmenter::segment(const rgbd::Frame& frame) const
{
  SceneSegmentation result;
  if (frame.depth_m.empty() || frame.depth_m.type() != CV_32FC1 || !frame.camera.violations().empty())
  {
    result.status = { base::StatusCode::BAD_INPUT,
                      "a frame without depth in metres or without usable intrinsics cannot "
                      "be segmented" };
    return result;
  }
  const WorkingImage image = makeWorkingImage(frame);
  const int with_depth = cv::countNonZero(image.frame.depth_m == image.frame.depth_m);
  if (with_depth == 0)
  {
    result.status = { base::StatusCode::NO_RESULT, "no plane: no pixel of the frame has depth" };
    return result;
  }
  PlaneGrowingOptions growing;
  growing.angle_rad = options_.plane_angle_rad;
  growing.distance_sigmas = options_.plane_distance_sigmas;
  growing.min_pixels = std::max(30, static_cast<int>(std::lround(options_.min_plane_ratio * with_depth)));
  const GrownPlanes planes = growPlanes(image, growing);
  if (planes.planes.empty())
  {
    result.status = { base::StatusCode::NO_RESULT,
                      "no plane: nothing flat covers " + std::to_string(options_.min_plane_ratio) +
                          " of the pixels with depth; let the camera see more of the table" };
    return result;
  }
  result.planes = fullPlanes(frame, image, planes, options_.plane_distance_sigmas);

  const std::vector<int> ranked = rankSupports(image, planes, options_.max_height_m);
  result.support_plane = ranked.front();
  for (std::size_t i = 0; i < std::min(ranked.size(), MAX_SUPPORTS_TRIED) && result.hypotheses.empty(); ++i)
  {
    result.hypotheses = findHypotheses(frame, image, planes, ranked[i], options_);
    if (!result.hypotheses.empty())
      result.support_plane = pedestalOn(ranked[i], ranked, planes, frame, image, options_, &result.hypotheses);
  }
  if (result.hypotheses.empty())
    result.status = { base::StatusCode::NO_RESULT, "no hypothesis: nothing of at least " +
                                                       std::to_string(options_.min_cluster_px) +
                                                       " px (at 640x480) stands on the support plane within " +
                                                       std::to_string(options_.max_distance_m) + " m" };
  return result;
}

}  // namespace object_modelling::segmentation
