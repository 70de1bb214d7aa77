#include "thin_walls.h"

#include <algorithm>
#include <cstdint>

namespace object_modelling::surface
{
namespace
{
constexpr std::size_t WALL_NEIGHBORS = 32;
constexpr std::size_t BACK_NEIGHBORS = 8;
constexpr float OPPOSITE_COSINE = -0.5f;  ///< between the normals of the two sides
constexpr float SAME_SIDE_COSINE = 0.3f;
/// How far noise may bring the sides past each other; surfaces that face each other across more are two.
constexpr float PAST_RATIO = 0.2f;
constexpr int SMOOTHINGS = 3;  ///< each over the nearest points of the same side

/// Distance to the other side behind a point; `none_m` without one nearer than that.
float thickness_m(std::size_t i, const std::vector<Eigen::Vector3f>& points,
                  const std::vector<Eigen::Vector3f>& normals,
                  const std::vector<geometry::PointIndex::Neighbor>& neighbors, float none_m)
{
  float thinnest_m = none_m;
  for (const geometry::PointIndex::Neighbor& neighbor : neighbors)
  {
    const Eigen::Vector3f& normal = normals[i];
    if (normals[neighbor.index].dot(normal) > OPPOSITE_COSINE)
      continue;
    const Eigen::Vector3f to_other = points[neighbor.index] - points[i];
    const float behind_m = -to_other.dot(normal);
    const float beside_m = (to_other + behind_m * normal).norm();
    if (behind_m > -PAST_RATIO * none_m && beside_m < none_m)
      thinnest_m = std::min(thinnest_m, std::max(behind_m, 0.f));
  }
  return thinnest_m;
}
}  // namespace

std::vector<float> spreadOfWalls_m(const std::vector<Eigen::Vector3f>& points,
                                   const std::vector<Eigen::Vector3f>& normals, const geometry::PointIndex& index,
                                   float min_thickness_m)
{
  const auto count = static_cast<std::int64_t>(points.size());
  std::vector<std::vector<geometry::PointIndex::Neighbor>> neighbors(points.size());
  std::vector<float> spread_m(points.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < count; ++i)
  {
    index.nearest(points[i], WALL_NEIGHBORS, &neighbors[i]);
    spread_m[i] = 0.5f * (min_thickness_m - thickness_m(i, points, normals, neighbors[i], min_thickness_m));
  }
  std::vector<float> smooth_m(points.size());
  for (int round = 0; round < SMOOTHINGS; ++round)
  {
#pragma omp parallel for schedule(static)
    for (std::int64_t i = 0; i < count; ++i)
    {
      float sum_m = 0, same_side = 0;
      for (const geometry::PointIndex::Neighbor& neighbor : neighbors[i])
        if (normals[neighbor.index].dot(normals[i]) > SAME_SIDE_COSINE)
        {
          sum_m += spread_m[neighbor.index];
          ++same_side;
        }
      smooth_m[i] = same_side > 0 ? sum_m / same_side : spread_m[i];
    }
    spread_m.swap(smooth_m);
  }
  return spread_m;
}

void takeSpreadBack(const std::vector<Eigen::Vector3f>& spread_points, const std::vector<Eigen::Vector3f>& normals,
                    const std::vector<float>& spread_m, mesh::TriangleMesh* mesh)
{
  if (std::all_of(spread_m.begin(), spread_m.end(), [](float value) { return value == 0; }))
    return;
  const geometry::PointIndex index(spread_points);
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(mesh->vertices.size()); ++i)
  {
    std::vector<geometry::PointIndex::Neighbor> neighbors;
    index.nearest(mesh->vertices[i], BACK_NEIGHBORS, &neighbors);
    Eigen::Vector3f moved = Eigen::Vector3f::Zero();
    float total = 0;
    for (const geometry::PointIndex::Neighbor& neighbor : neighbors)
    {
      const Eigen::Vector3f& normal = normals[neighbor.index];
      if (normal.dot(mesh->normals[i]) <= 0)
        continue;
      const float weight = 1 / (neighbor.squared_distance + 1e-9f);
      moved += weight * spread_m[neighbor.index] * normal;
      total += weight;
    }
    if (total > 0)
      mesh->vertices[i] -= moved / total;
  }
  mesh::computeNormals(mesh);
}

}  // namespace object_modelling::surface
