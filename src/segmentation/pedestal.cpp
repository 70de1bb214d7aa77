#include "pedestal.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "noise_table.h"

namespace object_modelling::segmentation
{
namespace
{
constexpr double SAMPLED_WIDTH_PX = 213;
constexpr float PEDESTAL_GATE_M = 0.004F;  // distortion, on top of the noise
constexpr float STEP_M = 0.003F;           // below that gate: lower than the plane for certain

/// Which thinned pixels lie in the plane and which below it; neither: above, or without depth.
struct Heights
{
  int step = 1;
  cv::Mat level, below;
};

Heights heightsAt(const rgbd::Frame& frame, const geometry::Plane& plane_camera, double noise_scale)
{
  Heights heights;
  heights.step = std::max(1, static_cast<int>(std::lround(frame.depth_m.cols / SAMPLED_WIDTH_PX)));
  const int step = heights.step;
  const cv::Size size((frame.depth_m.cols + step - 1) / step, (frame.depth_m.rows + step - 1) / step);
  heights.level = cv::Mat::zeros(size, CV_8UC1);
  heights.below = cv::Mat::zeros(size, CV_8UC1);
  const std::shared_ptr<const NoiseTable> noise = NoiseTable::of(frame.noise_model);
  const Eigen::Vector3f n = plane_camera.normal.cast<float>();
  const auto offset_m = static_cast<float>(plane_camera.offset_m);
  const auto sigmas = static_cast<float>(2 * noise_scale);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u)
    {
      const Eigen::Vector3f p = frame.point(u * step, v * step);
      if (!std::isfinite(p.z()))
        continue;
      const float height_m = n.dot(p) + offset_m;
      const float gate_m = PEDESTAL_GATE_M + sigmas * noise->sigmaAlong_m(n, p);
      if (std::abs(height_m) <= gate_m)
        heights.level.at<std::uint8_t>(v, u) = 255;
      else if (height_m < -gate_m - STEP_M)
        heights.below.at<std::uint8_t>(v, u) = 255;
    }
  return heights;
}

cv::Mat ellipse(int radius_px)
{
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * radius_px + 1, 2 * radius_px + 1));
}

/// The connected part of `level` that most of the seam round the object belongs to; empty if there is none.
cv::Mat carrying(const cv::Mat& level, const cv::Mat& object)
{
  constexpr int SEAM_PX = 3;
  cv::Mat seam, closed, labels;
  cv::dilate(object, seam, ellipse(SEAM_PX));
  cv::morphologyEx(level, closed, cv::MORPH_CLOSE, ellipse(1));
  closed.setTo(0, object);
  const int count = cv::connectedComponents(closed, labels, 4);
  std::vector<int> votes(static_cast<std::size_t>(count), 0);
  for (int v = 0; v < seam.rows; ++v)
    for (int u = 0; u < seam.cols; ++u)
      if (seam.at<std::uint8_t>(v, u) != 0)
        ++votes[static_cast<std::size_t>(labels.at<int>(v, u))];
  votes[0] = 0;
  const auto most = std::max_element(votes.begin(), votes.end());
  return *most > 0 ? cv::Mat(labels == static_cast<int>(most - votes.begin())) : cv::Mat();
}

/// Largest extent of the masked pixels, taken as points of the plane, in any of a few directions along it.
double sizeOf_m(const rgbd::Frame& frame, const geometry::Plane& plane_camera, const cv::Mat& mask, int step)
{
  constexpr int DIRECTIONS = 6;
  const Eigen::Vector3d x = plane_camera.normal.unitOrthogonal(), y = plane_camera.normal.cross(x);
  double low_m[DIRECTIONS], high_m[DIRECTIONS];
  std::fill_n(low_m, DIRECTIONS, std::numeric_limits<double>::infinity());
  std::fill_n(high_m, DIRECTIONS, -std::numeric_limits<double>::infinity());
  for (int v = 0; v < mask.rows; ++v)
    for (int u = 0; u < mask.cols; ++u)
    {
      if (mask.at<std::uint8_t>(v, u) == 0 || !std::isfinite(frame.depthAt_m(u * step, v * step)))
        continue;
      const Eigen::Vector3d p = frame.point(u * step, v * step).cast<double>();
      for (int i = 0; i < DIRECTIONS; ++i)
      {
        const double angle_rad = M_PI * i / DIRECTIONS;
        const double along_m = std::cos(angle_rad) * x.dot(p) + std::sin(angle_rad) * y.dot(p);
        low_m[i] = std::min(low_m[i], along_m);
        high_m[i] = std::max(high_m[i], along_m);
      }
    }
  double size_m = 0;
  for (int i = 0; i < DIRECTIONS; ++i)
    size_m = std::max(size_m, high_m[i] - low_m[i]);
  return size_m;
}

/// Whether what is round a part of the plane, and round the object on it, lies lower.
bool endsWithStepDown(const cv::Mat& part, const cv::Mat& object, const Heights& heights, double max_level_ratio)
{
  constexpr int RIM_PX = 2;  // missing and mixed depth
  constexpr int RING_PX = 5;
  constexpr double MIN_SEEN_RATIO = 0.25;
  constexpr double MAX_CUT_RATIO = 0.1;
  const cv::Mat body = part | object;
  cv::Mat near, far;
  cv::dilate(body, near, ellipse(RIM_PX));
  cv::dilate(body, far, ellipse(RING_PX));
  const cv::Mat ring = far & ~near;
  const int below = cv::countNonZero(ring & heights.below), level = cv::countNonZero(ring & heights.level);
  const int at_border = cv::countNonZero(part.row(0)) + cv::countNonZero(part.row(part.rows - 1)) +
                        cv::countNonZero(part.col(0)) + cv::countNonZero(part.col(part.cols - 1));
  return below + level >= MIN_SEEN_RATIO * cv::countNonZero(ring) && level <= max_level_ratio * (below + level) &&
         at_border <= MAX_CUT_RATIO * cv::countNonZero(ring) / (RING_PX - RIM_PX);
}

}  // namespace

cv::Mat findPedestal(const rgbd::Frame& frame, const geometry::Plane& plane_camera, const cv::Mat& object,
                     const PedestalOptions& options)
{
  constexpr int MARGIN_PX = 2;  // of the thinned image
  const Heights heights = heightsAt(frame, plane_camera, options.noise_scale);
  cv::Mat thin_object;
  cv::resize(object, thin_object, heights.level.size(), 0, 0, cv::INTER_NEAREST);
  const cv::Mat part = carrying(heights.level, thin_object);
  if (part.empty() || !endsWithStepDown(part, thin_object, heights, options.max_level_ratio))
    return {};
  const double size_m = sizeOf_m(frame, plane_camera, part, heights.step);
  if (size_m < options.min_size_m || size_m > options.max_size_m)
    return {};
  cv::Mat body, pedestal;
  cv::morphologyEx(part | thin_object, body, cv::MORPH_CLOSE, ellipse(MARGIN_PX));
  cv::erode(body, body, ellipse(MARGIN_PX), cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::resize(body, pedestal, object.size(), 0, 0, cv::INTER_NEAREST);
  pedestal.setTo(0, object);
  return pedestal;
}

}  // namespace object_modelling::segmentation
