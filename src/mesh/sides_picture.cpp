#include "sides_picture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
/// Camera on a sphere round the origin, `azimuth_rad` about z from x, looking at the origin with z up.
Eigen::Isometry3d orbit(double azimuth_rad, double elevation_rad, double distance_m)
{
  const Eigen::Vector3d forward =
      -Eigen::Vector3d(std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
                       std::sin(elevation_rad));
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T_model_camera = Eigen::Isometry3d::Identity();
  T_model_camera.linear() << right, forward.cross(right), forward;
  T_model_camera.translation() = -distance_m * forward;
  return T_model_camera.inverse();
}

}  // namespace

cv::Mat drawSides(const TriangleMesh& mesh, int count, int columns, int tile_size_px, const DrawView& draw)
{
  if (tile_size_px < 1 || count < 1)
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "tile_size_px = " + std::to_string(tile_size_px) +
                                                              ", count = " + std::to_string(count) +
                                                              ": must be at least 1");
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend(vertex);
  const Eigen::Vector3f center = box.isEmpty() ? Eigen::Vector3f(Eigen::Vector3f::Zero()) : box.center();
  double radius_m = 1e-3;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    radius_m = std::max<double>(radius_m, (vertex - center).norm());
  Eigen::Isometry3d T_centered_model = Eigen::Isometry3d::Identity();
  T_centered_model.translation() = -center.cast<double>();

  // A long lens: the sphere round the mesh just fits into the tile.
  constexpr double HALF_FIELD_RAD = 0.2, ELEVATION_RAD = 25 * M_PI / 180, MARGIN = 1.05;
  geometry::PinholeCamera camera;
  camera.width = camera.height = tile_size_px;
  camera.cx = camera.cy = 0.5 * (tile_size_px - 1);
  camera.fx = camera.fy = 0.5 * tile_size_px / std::tan(HALF_FIELD_RAD);
  const double distance_m = MARGIN * radius_m / std::sin(HALF_FIELD_RAD);

  cv::Mat picture(count / columns * tile_size_px, columns * tile_size_px, CV_8UC3);
  for (int i = 0; i < count; ++i)
  {
    const cv::Mat side = draw(camera, orbit(i * 2 * M_PI / count, ELEVATION_RAD, distance_m) * T_centered_model);
    side.copyTo(picture(cv::Rect(i % columns * tile_size_px, i / columns * tile_size_px, tile_size_px, tile_size_px)));
  }
  return picture;
}

}  // namespace object_modelling::mesh
