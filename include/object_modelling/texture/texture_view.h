#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/projection.h"
#include "object_modelling/mesh/triangle_mesh.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::texture
{
/// A view prepared for looking up what it shows of a mesh.
struct TextureView
{
  const rgbd::Frame* frame = nullptr;
  int light = 0;  ///< views of one light, that of their session, show a place alike
  Eigen::Isometry3f T_camera_mesh = Eigen::Isometry3f::Identity();
  Eigen::Vector3f p_mesh_camera = Eigen::Vector3f::Zero();
  Eigen::Vector2f color_offset_px = Eigen::Vector2f::Zero();
  cv::Mat nearest_surface_m;  ///< CV_32FC1: nearest depth of the mesh within OCCLUSION_MARGIN_PX, infinite without
  cv::Mat nearest_depth_m;    ///< CV_32FC1: nearest measured depth within a pixel's neighbours, infinite without
  cv::Mat rim_px;             ///< CV_32FC1: distance to what is no object: outside of the mask, or of the mesh
  cv::Mat smooth_bgr;         ///< CV_8UC3: colour without fine detail, for comparing views
  cv::Mat gradient;           ///< CV_32FC1: length of the gray levels' gradient per px
};

/// One point of the mesh as a view sees it.
struct Sighting
{
  float quality = 0;  ///< 0: not seen; otherwise resolution and angle: px^2 per m^2 of the surface, faded at rims
  Eigen::Vector2f color_px{ 0, 0 };  ///< in the colour image
};

/// The world of the views is the mesh's frame. Views without colour image are left out; result[i].frame gives the view
/// of result[i]. Throws base::Error (BAD_INPUT) for images that do not fit the camera.
std::vector<TextureView> prepareTextureViews(const mesh::TriangleMesh& mesh, const std::vector<rgbd::View>& views);

Sighting sight(const TextureView& view, const Eigen::Vector3f& p_mesh, const Eigen::Vector3f& n_mesh);

/// Pixel in the colour image of a point that the view has been found to see.
inline Eigen::Vector2f colorPixel(const TextureView& view, const Eigen::Vector3f& p_mesh)
{
  const Eigen::Vector3f p = view.T_camera_mesh * p_mesh;
  return geometry::pixelOf(view.frame->camera, p) + view.color_offset_px;
}

/// Side of a pixel on a surface across the line of sight.
inline float pixelSize_m(const TextureView& view, const Eigen::Vector3f& p_mesh)
{
  return (view.T_camera_mesh * p_mesh).z() / static_cast<float>(view.frame->camera.fx);
}

}  // namespace object_modelling::texture
