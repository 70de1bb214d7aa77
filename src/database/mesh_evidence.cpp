#include "object_modelling/database/mesh_evidence.h"

#include <limits>

#include "object_modelling/geometry/point_index.h"

namespace object_modelling::database
{
namespace
{
constexpr std::size_t SIGMA_NEIGHBORS = 4;
}

void markSeen(const fusion::FusedCloud& cloud, double max_distance_m, mesh::TriangleMesh* mesh)
{
  if (mesh->seen.empty())
    mesh->seen.assign(mesh->vertices.size(), 1);
  const geometry::PointIndex index(cloud.points);
  const auto max_squared_m2 = static_cast<float>(max_distance_m * max_distance_m);
  for (std::size_t i = 0; i < mesh->vertices.size(); ++i)
    if (cloud.points.empty() || index.nearest(mesh->vertices[i]).squared_distance > max_squared_m2)
      mesh->seen[i] = 0;
}

std::vector<float> sigmasOf(const fusion::FusedCloud& cloud, const mesh::TriangleMesh& mesh)
{
  if (cloud.points.empty())
    return {};
  const geometry::PointIndex index(cloud.points);
  std::vector<float> sigmas_m;
  std::vector<geometry::PointIndex::Neighbor> near;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    if (!mesh.seen.empty() && mesh.seen[i] == 0)
    {
      sigmas_m.push_back(std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    index.nearest(mesh.vertices[i], SIGMA_NEIGHBORS, &near);
    float sum_m = 0;
    for (const geometry::PointIndex::Neighbor& point : near)
      sum_m += cloud.sigmas_m[point.index];
    sigmas_m.push_back(sum_m / static_cast<float>(near.size()));
  }
  return sigmas_m;
}

}  // namespace object_modelling::database
