#include "debug_image.h"

#include <cmath>
#include <cstdio>

#include <opencv2/imgproc.hpp>

#include "object_modelling/geometry/projection.h"

namespace object_modelling::nodes
{
namespace
{
const cv::Scalar GREEN(80, 220, 80), RED(60, 60, 230), GRAY(160, 160, 160), ORANGE(0, 150, 255), BLACK(0, 0, 0);

cv::Scalar colorOf(const TrackingState& state)
{
  if (!state.recording)
    return GRAY;
  const bool good = state.status == TrackingState::TRACKING || state.status == TrackingState::RELOCALISED;
  return good ? GREEN : RED;
}

std::string textOf(const TrackingState& state)
{
  const char* words[] = { "not started", "tracking", "lost", "relocalised" };
  char text[160];
  std::snprintf(text, sizeof(text), "%s  %d/%d inliers  %.2f px  %d keyframes",
                state.recording ? words[state.status % 4] : "idle", state.inlier_count, state.feature_count,
                static_cast<double>(state.reprojection_rmse_px), state.keyframe_count);
  return text;
}

void write(cv::Mat& image, const std::string& text, int y_px)
{
  const double scale = image.cols / 1000.0;
  cv::putText(image, text, { 10, y_px }, cv::FONT_HERSHEY_SIMPLEX, scale, BLACK, 4, cv::LINE_AA);
  cv::putText(image, text, { 10, y_px }, cv::FONT_HERSHEY_SIMPLEX, scale, { 255, 255, 255 }, 1, cv::LINE_AA);
}
}  // namespace

void DebugImage::setKeyframe(const rgbd::Keyframe& keyframe)
{
  landmarks_session_.clear();
  for (const rgbd::Observation& seen : keyframe.observations)
    if (std::isfinite(seen.depth_m))
      landmarks_session_.push_back(
          keyframe.T_session_camera *
          keyframe.frame.camera.unproject(seen.pixel.x(), seen.pixel.y(), static_cast<double>(seen.depth_m)));
}

cv::Mat DebugImage::draw(const TrackedFrame& tracked) const
{
  cv::Mat image = tracked.frame->color_bgr.clone();
  const cv::Scalar color = colorOf(tracked.state);
  const cv::Mat& mask = tracked.frame->trackedMask();
  if (!mask.empty())
  {
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(mask.clone(), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(image, outlines, -1, ORANGE, 1);
  }
  if (tracked.result && tracked.result->tracked())
  {
    const Eigen::Isometry3d T_camera_session = tracked.result->T_session_camera.inverse();
    for (const Eigen::Vector3d& landmark : landmarks_session_)
    {
      const Eigen::Vector3d p_camera = T_camera_session * landmark;
      const geometry::Projection<double> at = geometry::projectionOf(tracked.frame->camera, p_camera);
      if (at.inside)
        cv::circle(image, { at.column, at.row }, 2, color, 1, cv::LINE_AA);
    }
  }
  cv::rectangle(image, { 0, 0, image.cols, image.rows }, color, 6);
  const int line_px = std::max(16, image.cols / 25);
  write(image, textOf(tracked.state), line_px);
  write(image, tracked.state.reason, 2 * line_px);
  return image;
}

}  // namespace object_modelling::nodes
