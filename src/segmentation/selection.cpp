#include <cmath>
#include <limits>

#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::segmentation
{
namespace
{
base::Result<int> nothing(const std::string& reason)
{
  return { { base::StatusCode::NO_RESULT, reason }, -1 };
}

std::string text(double value)
{
  return std::to_string(value);
}

/// 0 inside the box.
double distanceToBox_m(const geometry::OrientedBox& box, const Eigen::Vector3d& p_frame)
{
  const Eigen::Vector3d p_box = box.T_frame_box.inverse() * p_frame;
  return (p_box.cwiseAbs() - box.size_m / 2).cwiseMax(0.0).norm();
}

bool touchesBorder(const cv::Mat& mask)
{
  return cv::countNonZero(mask.row(0)) + cv::countNonZero(mask.row(mask.rows - 1)) + cv::countNonZero(mask.col(0)) +
             cv::countNonZero(mask.col(mask.cols - 1)) >
         0;
}

}  // namespace

base::Result<int> selectByPixel(const SceneSegmentation& segmentation, int u, int v)
{
  if (segmentation.hypotheses.empty())
    return nothing("there is no hypothesis to select from: " + segmentation.status.message);
  const cv::Size size = segmentation.hypotheses.front().mask.size();
  if (u < 0 || v < 0 || u >= size.width || v >= size.height)
    return { { base::StatusCode::INVALID_ARGUMENT, "pixel (" + std::to_string(u) + ", " + std::to_string(v) +
                                                       ") lies outside the " + std::to_string(size.width) + "x" +
                                                       std::to_string(size.height) + " image" },
             -1 };
  for (const Hypothesis& hypothesis : segmentation.hypotheses)
    if (hypothesis.mask.at<std::uint8_t>(v, u) != 0)
      return { {}, hypothesis.id };
  return nothing("no hypothesis covers pixel (" + std::to_string(u) + ", " + std::to_string(v) +
                 "); pick a pixel on the object");
}

base::Result<int> selectByPoint(const SceneSegmentation& segmentation, const Eigen::Vector3d& p_camera, double margin_m)
{
  if (segmentation.hypotheses.empty())
    return nothing("there is no hypothesis to select from: " + segmentation.status.message);
  if (!p_camera.allFinite() || !(margin_m >= 0))
    return { { base::StatusCode::INVALID_ARGUMENT, "a point and a margin to select by must be finite numbers" }, -1 };
  // Boxes of neighbours may overlap: of equal distances the nearer centre decides.
  const Hypothesis* best = nullptr;
  double best_distance_m = std::numeric_limits<double>::infinity(), best_to_center_m = best_distance_m;
  for (const Hypothesis& hypothesis : segmentation.hypotheses)
  {
    const double distance_m = distanceToBox_m(hypothesis.box_camera, p_camera);
    const double to_center_m = (hypothesis.centroid_camera - p_camera).norm();
    if (distance_m < best_distance_m || (distance_m == best_distance_m && to_center_m < best_to_center_m))
    {
      best = &hypothesis;
      best_distance_m = distance_m;
      best_to_center_m = to_center_m;
    }
  }
  if (best_distance_m > margin_m)
    return nothing("the nearest hypothesis is " + text(best_distance_m) + " m from the point, margin " +
                   text(margin_m) + " m");
  return { {}, best->id };
}

double clearness(const Hypothesis& hypothesis, const geometry::PinholeCamera& camera)
{
  const Eigen::Vector2d pixel = camera.project(hypothesis.centroid_camera);
  const Eigen::Vector2d off_center((pixel.x() - (camera.width - 1) / 2.0) / camera.width,
                                   (pixel.y() - (camera.height - 1) / 2.0) / camera.width);
  constexpr double REACH = 0.25;  // of the image's width
  const double size = std::sqrt(hypothesis.pixel_count / (static_cast<double>(camera.width) * camera.height));
  return size * std::exp(-off_center.squaredNorm() / (2 * REACH * REACH)) * (touchesBorder(hypothesis.mask) ? 0.4 : 1);
}

base::Result<int> selectAutomatically(const SceneSegmentation& segmentation, const geometry::PinholeCamera& camera)
{
  if (segmentation.hypotheses.empty())
    return nothing("there is no hypothesis to select from: " + segmentation.status.message);
  int best = -1;
  double best_score = -1;
  for (const Hypothesis& hypothesis : segmentation.hypotheses)
    if (const double score = clearness(hypothesis, camera); score > best_score)
    {
      best = hypothesis.id;
      best_score = score;
    }
  return { {}, best };
}

}  // namespace object_modelling::segmentation
