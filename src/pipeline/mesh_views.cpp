#include "mesh_views.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "object_modelling/mesh/mesh_renderer.h"
#include "object_modelling/mesh/textured_renderer.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double MIN_DISTANCE_M = 0.4;      // what depth cameras need
constexpr double DISTANCE_DIAMETERS = 1.4;  // the whole object fills most of the image

geometry::PinholeCamera camera()
{
  geometry::PinholeCamera pinhole;
  pinhole.width = 640;
  pinhole.height = 480;
  pinhole.fx = pinhole.fy = 525;
  pinhole.cx = 319.5;
  pinhole.cy = 239.5;
  return pinhole;
}

std::vector<Eigen::Vector3d> directions()
{
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<Eigen::Vector3d> corners;
  for (const double a : { -1.0, 1.0 })
    for (const double b : { -golden, golden })
      for (const Eigen::Vector3d& corner :
           { Eigen::Vector3d(0, a, b), Eigen::Vector3d(a, b, 0), Eigen::Vector3d(b, 0, a) })
        corners.push_back(corner.normalized());
  std::vector<Eigen::Vector3d> all = corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j)
      if (corners[i].dot(corners[j]) > 0.4)  // neighbours
        all.push_back((corners[i] + corners[j]).normalized());
  return all;
}

/// Optical frame that looks at the origin, upright.
Eigen::Isometry3d lookingAtOrigin(const Eigen::Vector3d& from_m)
{
  const Eigen::Vector3d z = -from_m.normalized();
  const Eigen::Vector3d up = std::abs(z.z()) > 0.99 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d x = z.cross(up).normalized();
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() << x, z.cross(x), z;
  T_world_camera.translation() = from_m;
  return T_world_camera;
}
}  // namespace

std::vector<rgbd::View> renderedViews(const mesh::TexturedMesh& textured, double diameter_m, base::JobControl& control)
{
  const std::vector<Eigen::Vector3d> all = directions();
  const double distance_m = std::max(MIN_DISTANCE_M, DISTANCE_DIAMETERS * diameter_m);
  std::vector<rgbd::View> views;
  for (const Eigen::Vector3d& direction : all)
  {
    control.report("render views", views.size(), all.size());
    rgbd::View view;
    view.T_world_camera = lookingAtOrigin(distance_m * direction);
    view.frame.camera = camera();
    view.frame.stamp_s = static_cast<double>(views.size());
    const Eigen::Isometry3d T_camera_model = view.T_world_camera.inverse();
    const mesh::MeshView picture = textured.texture_bgr.empty()
                                       ? mesh::renderMesh(textured.mesh, view.frame.camera, T_camera_model)
                                       : mesh::renderTexturedMesh(textured, view.frame.camera, T_camera_model);
    view.frame.color_bgr = picture.color_bgr;
    cv::cvtColor(picture.color_bgr, view.frame.gray, cv::COLOR_BGR2GRAY);
    view.frame.depth_m = picture.depth_m;
    view.frame.object_mask = picture.triangle_id >= 0;
    views.push_back(std::move(view));
  }
  control.report("render views", all.size(), all.size());
  return views;
}

}  // namespace object_modelling::pipeline
