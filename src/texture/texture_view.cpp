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
constexpr int OCCLUSION_MARGIN_PX = 2;    ///< colour this near to something in front is mixed with its
constexpr float MIN_SIGHT_COSINE = 0.2f;  ///< flatter sights smear
constexpr float MIN_RIM_PX = 2.5f;        ///< colour nearer to the rim is mixed with the background
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

void checkView(const rgbd::View& view, std::size_t index)
{
  const rgbd::Frame& frame = view.frame;
  const cv::Size size(frame.camera.width, frame.camera.height);
  const auto fits = [&](const cv::Mat& image, int type) { return image.type() == type && image.size() == size; };
  if (!frame.camera.violations().empty() || !rgbd::isPlaced(view) || !fits(frame.color_bgr, CV_8UC3) ||
      !(frame.depth_m.empty() || fits(frame.depth_m, CV_32FC1)) ||
      !(frame.object_mask.empty() || fits(frame.object_mask, CV_8UC1)))
    throw base::Error(base::StatusCode::BAD_INPUT,
                      "view " + std::to_string(index) +
                          " cannot be used for texture: colour, depth, mask, camera, "
                          "pose, colour offset and session must be sound and fit together");
}

TextureView prepare(const mesh::TriangleMesh& mesh, const rgbd::View& view)
{
  const rgbd::Frame& frame = view.frame;
  const Eigen::Isometry3d& T_mesh_camera = view.T_world_camera;
  TextureView prepared;
  prepared.frame = &frame;
  prepared.light = view.session_index;
  prepared.T_camera_mesh = T_mesh_camera.inverse().cast<float>();
  prepared.p_mesh_camera = T_mesh_camera.translation().cast<float>();
  prepared.color_offset_px = view.color_offset_px.cast<float>();
  const mesh::MeshView rendered = mesh::renderMesh(mesh, frame.camera, T_mesh_camera.inverse());
  prepared.nearest_surface_m = nearestDepth(rendered.depth_m, OCCLUSION_MARGIN_PX);
  if (!frame.depth_m.empty())
    prepared.nearest_depth_m = nearestDepth(frame.depth_m, 1);
  cv::Mat object = rendered.triangle_id >= 0;
  if (!frame.object_mask.empty())
  {
    cv::Mat mask;  // without the pinholes that missing depth leaves
    cv::morphologyEx(frame.object_mask, mask, cv::MORPH_CLOSE, cv::Mat::ones(PINHOLE_PX, PINHOLE_PX, CV_8UC1));
    object &= mask;
  }
  cv::distanceTransform(object, prepared.rim_px, cv::DIST_L2, 5);
  cv::GaussianBlur(frame.color_bgr, prepared.smooth_bgr, cv::Size(), SMOOTHING_PX);
  cv::Mat gray, along_u, along_v;
  cv::cvtColor(frame.color_bgr, gray, cv::COLOR_BGR2GRAY);
  cv::Sobel(gray, along_u, CV_32F, 1, 0, 3, 1. / 8);
  cv::Sobel(gray, along_v, CV_32F, 0, 1, 3, 1. / 8);
  cv::magnitude(along_u, along_v, prepared.gradient);
  return prepared;
}
}  // namespace

std::vector<TextureView> prepareTextureViews(const mesh::TriangleMesh& mesh, const std::vector<rgbd::View>& views)
{
  std::vector<const rgbd::View*> usable;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    const rgbd::Frame& frame = views[i].frame;
    if (frame.color_bgr.empty())
      continue;
    checkView(views[i], i);
    if (frame.object_mask.empty() || cv::countNonZero(frame.object_mask) > 0)
      usable.push_back(&views[i]);
  }
  std::vector<TextureView> prepared(usable.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(usable.size()); ++i)
    prepared[i] = prepare(mesh, *usable[i]);
  return prepared;
}

Sighting sight(const TextureView& view, const Eigen::Vector3f& p_mesh, const Eigen::Vector3f& n_mesh)
{
  Sighting result;
  const Eigen::Vector3f to_camera = view.p_mesh_camera - p_mesh;
  const float cosine = n_mesh.dot(to_camera) / to_camera.norm();
  if (!(cosine > MIN_SIGHT_COSINE))
    return result;
  const geometry::PinholeCamera& camera = view.frame->camera;
  const Eigen::Vector3f p_camera = view.T_camera_mesh * p_mesh;
  const geometry::Projection<float> at = geometry::projectionOf(camera, p_camera, 1);
  if (!at.inside)
    return result;
  result.color_px = at.pixel() + view.color_offset_px;
  if (!camera.contains(result.color_px.cast<double>(), 1))
    return result;
  const float rim_px = view.rim_px.at<float>(at.row, at.column);
  if (!(rim_px >= MIN_RIM_PX))
    return result;

  const float pixel_m = pixelSize_m(view, p_mesh);
  const float slope_m_per_px = pixel_m * std::sqrt(1 / (cosine * cosine) - 1);
  if (view.nearest_surface_m.at<float>(at.row, at.column) <
      at.z_m - SURFACE_TOLERANCE_M - (OCCLUSION_MARGIN_PX + 1) * 1.5f * slope_m_per_px)
    return result;
  if (!view.nearest_depth_m.empty())
  {
    const float tolerance_m = DEPTH_TOLERANCE_M +
                              3 * static_cast<float>(view.frame->noise_model.axialSigma_m(at.z_m, 0)) +
                              2 * slope_m_per_px;
    const rgbd::Visibility seen = rgbd::visibilityOf(at, view.frame->depth_m, tolerance_m);
    const rgbd::Visibility round = rgbd::visibilityOf(at, view.nearest_depth_m, tolerance_m);
    const bool unknown = seen == rgbd::Visibility::UNKNOWN && view.frame->object_mask.empty();
    if (round == rgbd::Visibility::BEHIND || seen == rgbd::Visibility::IN_FRONT || unknown)
      return result;
  }
  const float rim_fade = std::min(1.f, (rim_px - MIN_RIM_PX + 0.25f) / (FULL_RIM_PX - MIN_RIM_PX));
  result.quality = cosine * rim_fade / (pixel_m * pixel_m);
  return result;
}

}  // namespace object_modelling::texture
