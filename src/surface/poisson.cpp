#include "poisson.h"

#include <algorithm>
#include <cmath>

#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>
#include <Eigen/Geometry>

namespace object_modelling::surface
{
namespace
{
constexpr float BOX_SCALE = 1.1f;  ///< edge of the octree over that of the points
// Fused points are averaged already. With the usual weight of 4 the sides of a thin wall pull each other flat.
constexpr float POINT_WEIGHT = 60;
constexpr int MIN_DEPTH = 4, MAX_DEPTH = 10;

}  // namespace

mesh::TriangleMesh poissonSurface(const std::vector<Eigen::Vector3f>& points,
                                  const std::vector<Eigen::Vector3f>& normals, double cell_size_m)
{
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  cloud->resize(points.size());
  Eigen::AlignedBox3f box;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    (*cloud)[i].getVector3fMap() = points[i];
    (*cloud)[i].getNormalVector3fMap() = normals[i];
    box.extend(points[i]);
  }
  // The octree is as large as makes its cells just as large as asked for: else objects of nearly the same size would be
  // meshed twice as finely, or not.
  const double size_m = std::max<double>(box.sizes().maxCoeff(), cell_size_m);  // all points may be in one place
  const double cells = BOX_SCALE * size_m / cell_size_m;
  const int depth = std::clamp(static_cast<int>(std::ceil(std::log2(std::max(cells, 1.0)))), MIN_DEPTH, MAX_DEPTH);
  const double scale = std::max<double>(BOX_SCALE, cell_size_m * std::exp2(depth) / size_m);

  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(depth);
  poisson.setScale(static_cast<float>(scale));
  poisson.setPointWeight(POINT_WEIGHT);
  poisson.setInputCloud(cloud);
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> polygons;
  poisson.performReconstruction(vertices, polygons);

  mesh::TriangleMesh mesh;
  for (const pcl::PointNormal& vertex : vertices)
    mesh.vertices.push_back(vertex.getVector3fMap());
  for (const pcl::Vertices& polygon : polygons)
  {
    mesh.triangles.push_back({ static_cast<std::uint32_t>(polygon.vertices[0]),
                               static_cast<std::uint32_t>(polygon.vertices[1]),
                               static_cast<std::uint32_t>(polygon.vertices[2]) });
  }
  return mesh;
}

}  // namespace object_modelling::surface
