#include "object_modelling/texture/texture_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/status.h"
#include "object_modelling/mesh/mesh_renderer.h"
#include "object_modelling/rgbd/sensor_noise_model.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::texture
{
namespace
{
constexpr int OCCLUSION_MARGIN_PX = 2;  ///< colour this near to something in front is mixed with its
constexpr float MIN_COSINE = 0.2f;      ///< flatter sights smear
constexpr float MIN_RIM_PX = 2.5f;      ///< colour nearer to the rim is mixed with the background
constexpr float FULL_RIM_PX = 7.f;
constexpr float SURFACE_TOLERANCE_M = 0.0015f;  ///< of the mesh against itself
constexpr float DEPTH_TOLERANCE_M = 0.004f;     ///< of the mesh against measured depth, besides 3 sigmas
constexpr double SMOOTHING_PX = 1.5;
constexpr int PINHOLE_PX = 5;

cv::Mat nearestDepth(const cv::Mat& depth_m, int radius_px)
{
  cv::Mat nearest_m = depth_m.clone();
  cv::patchNaNs(nearest_m, std::numeric_limits<float>::infinity());
  const int side = 2 * radius_px + 1;
  cv::erode(nearest_m, nearest_m, cv::Mat::ones(side, side, CV_8UC1), cv::Point(-1, -1), 1, cv::BORDER_REPLICATE);
  return nearest_m;
}

void checkImages(const rgbd::Keyframe& keyframe)
{
  const rgbd::Frame& frame = keyframe.frame;
  const cv::Size size(frame.camera.width, frame.camera.height);
  const auto fits = [&](const cv::Mat& image, int type) { return image.type() == type && image.size() == size; };
  if (!frame.camera.violations().empty() || !keyframe.T_session_camera.matrix().allFinite() ||
      !fits(frame.color_bgr, CV_8UC3) || !(frame.depth_m.empty() || fits(frame.depth_m, CV_32FC1)) ||
      !(frame.object_mask.empty() || fits(frame.object_mask, CV_8UC1)))
    throw base::Error(base::StatusCode::BAD_INPUT, "keyframe " + std::to_string(keyframe.id) +
                                                       " cannot be used for texture: colour, depth, mask, camera "
                                                       "and pose must be sound and fit together");
}

TextureView prepare(const mesh::TriangleMesh& mesh, const rgbd::Keyframe& keyframe,
                    const Eigen::Vector2d& color_offset_px)
{
  TextureView view;
  view.frame = &keyframe.frame;
  view.T_camera_mesh = keyframe.T_session_camera.inverse().cast<float>();
  view.p_mesh_camera = keyframe.T_session_camera.translation().cast<float>();
  view.color_offset_px = color_offset_px.cast<float>();
  const mesh::MeshView rendered = mesh::renderMesh(mesh, keyframe.frame.camera, keyframe.T_session_camera.inverse());
  view.nearest_surface_m = nearestDepth(rendered.depth_m, OCCLUSION_MARGIN_PX);
  if (!keyframe.frame.depth_m.empty())
    view.nearest_depth_m = nearestDepth(keyframe.frame.depth_m, 1);
  cv::Mat object = rendered.triangle_id >= 0;
  if (!keyframe.frame.object_mask.empty())
  {
    cv::Mat mask;  // without the pinholes that missing depth leaves
    cv::morphologyEx(keyframe.frame.object_mask, mask, cv::MORPH_CLOSE, cv::Mat::ones(PINHOLE_PX, PINHOLE_PX, CV_8UC1));
    object &= mask;
  }
  cv::distanceTransform(object, view.rim_px, cv::DIST_L2, 5);
  cv::GaussianBlur(keyframe.frame.color_bgr, view.smooth_bgr, cv::Size(), SMOOTHING_PX);
  cv::Mat gray, along_u, along_v;
  cv::cvtColor(keyframe.frame.color_bgr, gray, cv::COLOR_BGR2GRAY);
  cv::Sobel(gray, along_u, CV_32F, 1, 0, 3, 1. / 8);
  cv::Sobel(gray, along_v, CV_32F, 0, 1, 3, 1. / 8);
  cv::magnitude(along_u, along_v, view.gradient);
  return view;
}
}  // namespace

std::vector<TextureView> prepareTextureViews(const mesh::TriangleMesh& mesh,
                                             const std::vector<rgbd::Keyframe>& keyframes,
                                             const std::vector<int>& lights, const Eigen::Vector2d& color_offset_px)
{
  std::vector<const rgbd::Keyframe*> usable;
  std::vector<int> light_of;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
  {
    const rgbd::Keyframe& keyframe = keyframes[i];
    if (keyframe.frame.color_bgr.empty())
      continue;
    checkImages(keyframe);
    if (keyframe.frame.object_mask.empty() || cv::countNonZero(keyframe.frame.object_mask) > 0)
    {
      usable.push_back(&keyframe);
      light_of.push_back(lights.empty() ? 0 : lights[i]);
    }
  }
  std::vector<TextureView> views(usable.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(usable.size()); ++i)
  {
    views[i] = prepare(mesh, *usable[i], color_offset_px);
    views[i].light = light_of[i];
  }
  return views;
}

Sighting sight(const TextureView& view, const Eigen::Vector3f& p_mesh, const Eigen::Vector3f& n_mesh)
{
  Sighting result;
  const Eigen::Vector3f to_camera = view.p_mesh_camera - p_mesh;
  const float cosine = n_mesh.dot(to_camera) / to_camera.norm();
  const float z_m = (view.T_camera_mesh * p_mesh).z();
  if (!(cosine > MIN_COSINE) || !(z_m > 0))
    return result;
  const geometry::PinholeCamera& camera = view.frame->camera;
  result.color_px = colorPixel(view, p_mesh);
  const Eigen::Vector2f pixel = result.color_px - view.color_offset_px;
  if (!camera.contains(pixel.cast<double>(), 1) || !camera.contains(result.color_px.cast<double>(), 1))
    return result;
  const int u = cvRound(pixel.x()), v = cvRound(pixel.y());
  const float rim_px = view.rim_px.at<float>(v, u);
  if (!(rim_px >= MIN_RIM_PX))
    return result;

  const float pixel_m = pixelSize_m(view, p_mesh);
  const float slope_m_per_px = pixel_m * std::sqrt(1 / (cosine * cosine) - 1);
  if (view.nearest_surface_m.at<float>(v, u) <
      z_m - SURFACE_TOLERANCE_M - (OCCLUSION_MARGIN_PX + 1) * 1.5f * slope_m_per_px)
    return result;
  if (!view.nearest_depth_m.empty())
  {
    const float tolerance_m =
        DEPTH_TOLERANCE_M + 3 * static_cast<float>(view.frame->noise_model.axialSigma_m(z_m, 0)) + 2 * slope_m_per_px;
    const rgbd::Visibility seen = rgbd::visibilityOf(z_m, view.frame->depthAt_m(u, v), tolerance_m);
    const rgbd::Visibility round = rgbd::visibilityOf(z_m, view.nearest_depth_m.at<float>(v, u), tolerance_m);
    const bool unknown = seen == rgbd::Visibility::UNKNOWN && view.frame->object_mask.empty();
    if (round == rgbd::Visibility::BEHIND || seen == rgbd::Visibility::IN_FRONT || unknown)
      return result;
  }
  const float rim_fade = std::min(1.f, (rim_px - MIN_RIM_PX + 0.25f) / (FULL_RIM_PX - MIN_RIM_PX));
  result.quality = cosine * rim_fade / (pixel_m * pixel_m);
  return result;
}

}  // namespace object_modelling::texture
