#include "support_around.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "cropped_frame.h"
#include "noise_table.h"
#include "plane_growing.h"

namespace object_modelling::segmentation
{
namespace
{
constexpr int MIN_POINTS = 150;
constexpr double SUPPORT_GATE_M = 0.004;  // distortion and pose error, on top of the noise
constexpr double MAX_TILT_COS = 0.9986;   // 3 deg

/// Heights of the masked points, sorted.
std::vector<double> heightsOf(const rgbd::Frame& frame, const cv::Mat& mask, const cv::Rect& rect,
                              const geometry::Plane& plane_camera)
{
  constexpr int STRIDE = 2;
  std::vector<double> heights_m;
  for (int v = rect.y; v < rect.y + rect.height; v += STRIDE)
    for (int u = rect.x; u < rect.x + rect.width; u += STRIDE)
      if (mask.at<std::uint8_t>(v, u) != 0 && std::isfinite(frame.depthAt_m(u, v)))
        heights_m.push_back(plane_camera.signedDistance_m(frame.point(u, v).cast<double>()));
  std::sort(heights_m.begin(), heights_m.end());
  return heights_m;
}

/// Whether an object with these sorted heights can rest on the plane they are measured from.
bool rests(const std::vector<double>& heights_m, double range_m)
{
  const double tolerance_m = 0.004 + 0.01 * range_m;
  const double lowest_m = heights_m[heights_m.size() / 50];  // 2 %: masks take a little of the support along
  return lowest_m > -tolerance_m && lowest_m < 0.015 + tolerance_m;
}

}  // namespace

std::optional<LocalSupport> refineSupport(const rgbd::Frame& frame, const geometry::Plane& known_camera,
                                          const cv::Rect& area, const cv::Mat& object)
{
  constexpr int STRIDE = 2;
  const std::shared_ptr<const NoiseTable> noise = NoiseTable::of(frame.noise_model);
  LocalSupport support{ known_camera, {}, 1 };
  for (const double gate_m : { SUPPORT_GATE_M, SUPPORT_GATE_M / 2 })
  {
    PlaneMoments moments;
    const auto n = support.plane_camera.normal.cast<float>().eval();
    const auto offset_m = static_cast<float>(support.plane_camera.offset_m);
    for (int v = area.y; v < area.y + area.height; v += STRIDE)
      for (int u = area.x; u < area.x + area.width; u += STRIDE)
      {
        const float z = frame.depthAt_m(u, v);
        if (!std::isfinite(z) || (!object.empty() && object.at<std::uint8_t>(v, u) != 0))
          continue;
        const Eigen::Vector3f p = frame.point(u, v);
        const float sigma_m = noise->sigmaAlong_m(n, p);
        if (std::abs(n.dot(p) + offset_m) <= static_cast<float>(gate_m) + 2 * sigma_m)
          moments.add(p.cast<double>(), 1.0 / (static_cast<double>(sigma_m) * sigma_m));
      }
    if (moments.count < MIN_POINTS || !moments.fit(Eigen::Vector3d::Zero(), &support.plane_camera) ||
        support.plane_camera.normal.dot(known_camera.normal) < MAX_TILT_COS)
      return std::nullopt;
    support.moments = moments;
    support.noise_scale = std::max(1.0, std::sqrt(moments.meanSquare(support.plane_camera)));
  }
  return support;
}

std::optional<LocalSupport> findSupportAround(const rgbd::Frame& frame, const cv::Mat& object_mask)
{
  constexpr double RING_RATIO = 0.35;  // of the mask's larger side
  constexpr int RIM_PX = 3;            // whose pixels may be the object's
  const cv::Rect rect = cv::boundingRect(object_mask);
  if (rect.area() == 0)
    return std::nullopt;
  const int ring_px = std::max(10, static_cast<int>(RING_RATIO * std::max(rect.width, rect.height)));
  const cv::Rect area =
      cv::Rect(rect.x - ring_px, rect.y - ring_px, rect.width + 2 * ring_px, rect.height + 2 * ring_px) &
      cv::Rect(0, 0, object_mask.cols, object_mask.rows);
  cv::Mat ignored;
  cv::dilate(object_mask(area), ignored,
             cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * RIM_PX + 1, 2 * RIM_PX + 1)));
  const WorkingImage image = makeWorkingImage(cropped(frame, area), ignored);
  PlaneGrowingOptions options;
  options.min_pixels = MIN_POINTS;
  const GrownPlanes planes = growPlanes(image, options);
  for (const GrownPlane& grown : planes.planes)
  {
    const std::vector<double> heights_m = heightsOf(frame, object_mask, rect, grown.plane);
    if (!heights_m.empty() && rests(heights_m, grown.moments.mean().z()))
      return LocalSupport{ grown.plane, grown.moments, grown.noise_scale };
  }
  return std::nullopt;
}

}  // namespace object_modelling::segmentation
