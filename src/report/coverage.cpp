#include "object_modelling/report/coverage.h"

#include <cmath>

#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::report
{
namespace
{
constexpr double DEPTH_TOLERANCE_M = 0.005, MIN_COSINE = 0.17, BORDER_PX = 0.5;

bool sees(const rgbd::View& view, const Eigen::Vector3d& p_camera, const Eigen::Vector3d& n_camera)
{
  if (!(p_camera.z() > 0) || -n_camera.dot(p_camera.normalized()) < MIN_COSINE)
    return false;
  const geometry::Projection<double> at = geometry::projectionOf(view.frame.camera, p_camera, BORDER_PX);
  return rgbd::visibilityOf(at, view.frame.depth_m, DEPTH_TOLERANCE_M) == rgbd::Visibility::ON;
}

void countDirections(const std::vector<rgbd::View>& views, Coverage* coverage)
{
  double area = 0, upper_area = 0;
  for (int row = 0; row < ELEVATION_BINS; ++row)
  {
    const double elevation_rad = ((row + 0.5) / ELEVATION_BINS - 0.5) * M_PI;
    for (int column = 0; column < AZIMUTH_BINS; ++column)
    {
      const double azimuth_rad = (column + 0.5) / AZIMUTH_BINS * 2 * M_PI;
      const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                      std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
      int& count = coverage->view_counts[row][column];
      for (const rgbd::View& view : views)
        count += view.T_world_camera.translation().normalized().dot(direction) >= std::cos(VIEW_CONE_RAD);
      const double share = std::cos(elevation_rad);  // of the bin's area
      area += share;
      coverage->direction_ratio += count > 0 ? share : 0;
      if (elevation_rad < 0)
        continue;
      upper_area += share;
      coverage->upper_direction_ratio += count > 0 ? share : 0;
    }
  }
  coverage->direction_ratio /= area;
  coverage->upper_direction_ratio /= upper_area;
}
}  // namespace

Coverage coverageOf(const mesh::TriangleMesh& mesh, const std::vector<rgbd::View>& views)
{
  Coverage coverage;
  countDirections(views, &coverage);
  mesh::TriangleMesh with_normals;
  const mesh::TriangleMesh* shape = &mesh;
  if (mesh.normals.empty())
  {
    with_normals = mesh;
    mesh::computeNormals(&with_normals);
    shape = &with_normals;
  }
  std::vector<int> seen_by(shape->vertices.size(), 0);
  for (const rgbd::View& view : views)
  {
    const Eigen::Isometry3d T_camera_model = view.T_world_camera.inverse();
    for (std::size_t i = 0; i < seen_by.size(); ++i)
      seen_by[i] += sees(view, T_camera_model * shape->vertices[i].cast<double>(),
                         T_camera_model.linear() * shape->normals[i].cast<double>());
  }
  for (const int count : seen_by)
  {
    coverage.seen_ratio += count > 0;
    coverage.well_seen_ratio += count >= WELL_SEEN_VIEWS;
  }
  if (!seen_by.empty())
  {
    coverage.seen_ratio /= static_cast<double>(seen_by.size());
    coverage.well_seen_ratio /= static_cast<double>(seen_by.size());
  }
  return coverage;
}

}  // namespace object_modelling::report
