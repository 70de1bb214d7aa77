#include "object_modelling/surface/surface_reconstruction.h"

#include <algorithm>
#include <cmath>

#include "closed_base.h"
#include "mesh_cleaning.h"
#include "mesh_closing.h"
#include "object_modelling/base/options.h"
#include "object_modelling/geometry/point_index.h"
#include "object_modelling/mesh/decimation.h"
#include "poisson.h"
#include "thin_walls.h"

namespace object_modelling::surface
{
namespace
{
constexpr std::size_t MIN_POINTS = 50;
constexpr std::size_t VOTING_NEIGHBORS = 24;
constexpr std::size_t COLOR_NEIGHBORS = 4;
/// Surface this near to a fused point is seen even at the rim of the cloud; in units of the resolution.
constexpr float RIM_RATIO = 1.f;
constexpr double CELL_RATIO = 0.5;  ///< of the resolution: between the two sides of a thin wall there must be cells
/// Poisson's surfaces need a few cells between them: the sides of a thinner wall are meshed this far apart and taken
/// back.
constexpr double WALL_RATIO = 1.75;
constexpr double MIN_PIECE_RATIO = 0.005;  ///< of the largest piece's area
/// Half the width of gaps that are closed, in units of the support distance: wider ones bulge.
constexpr double GAP_RATIO = 0.7;
/// PCL leaves out triangles where cells of different size meet ("Vertex pair not in list").
constexpr std::size_t MAX_TINY_EDGES = 8;
constexpr double TEETH_RATIO = 0.5;  ///< half the width of what is cut off the rim; in units of the resolution
constexpr int STAGES = 4;

/// Largest angle (rad) about `normal` through which no neighbour lies, seen from `center`.
float largestGap_rad(const Eigen::Vector3f& center, const Eigen::Vector3f& normal,
                     const std::vector<Eigen::Vector3f>& neighbors)
{
  const Eigen::Vector3f e1 = normal.unitOrthogonal(), e2 = normal.cross(e1);
  std::vector<float> angles_rad;
  for (const Eigen::Vector3f& neighbor : neighbors)
    angles_rad.push_back(std::atan2(e2.dot(neighbor - center), e1.dot(neighbor - center)));
  if (angles_rad.empty())
    return static_cast<float>(2 * M_PI);
  std::sort(angles_rad.begin(), angles_rad.end());
  float gap_rad = static_cast<float>(2 * M_PI) - (angles_rad.back() - angles_rad.front());
  for (std::size_t i = 1; i < angles_rad.size(); ++i)
    gap_rad = std::max(gap_rad, angles_rad[i] - angles_rad[i - 1]);
  return gap_rad;
}

/// Whether the cloud vouches for a vertex: a fused point of the same side lies close by, or they surround it within the
/// support distance. What lies beyond the cloud's rim has nothing on its far side.
bool supported(const Eigen::Vector3f& vertex, const Eigen::Vector3f& normal, const fusion::FusedCloud& cloud,
               const geometry::PointIndex& index, const SurfaceOptions& options)
{
  std::vector<geometry::PointIndex::Neighbor> neighbors;
  index.nearest(vertex, VOTING_NEIGHBORS, &neighbors);
  const double near_m = RIM_RATIO * options.resolution_m;
  std::vector<Eigen::Vector3f> around;
  for (const geometry::PointIndex::Neighbor& neighbor : neighbors)
  {
    if (neighbor.squared_distance > options.max_support_distance_m * options.max_support_distance_m)
      break;
    if (cloud.normals[neighbor.index].dot(normal) <= 0)
      continue;
    if (neighbor.squared_distance < near_m * near_m)
      return true;
    around.push_back(cloud.points[neighbor.index]);
  }
  return largestGap_rad(vertex, normal, around) < M_PI;
}

void colorFromCloud(const fusion::FusedCloud& cloud, const geometry::PointIndex& index, mesh::TriangleMesh* mesh)
{
  mesh->colors.resize(mesh->vertices.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(mesh->vertices.size()); ++i)
  {
    std::vector<geometry::PointIndex::Neighbor> neighbors;
    index.nearest(mesh->vertices[i], COLOR_NEIGHBORS, &neighbors);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weight = 0;
    for (const geometry::PointIndex::Neighbor& neighbor : neighbors)
    {
      // Points of the other side of a thin wall count only where there is no other.
      const bool same_side = cloud.normals[neighbor.index].dot(mesh->normals[i]) > 0;
      const float w = (same_side ? 1.f : 1e-6f) / (neighbor.squared_distance + 1e-9f);
      sum += w * cloud.colors[neighbor.index].cast<float>();
      weight += w;
    }
    mesh->colors[i] = (sum / weight + Eigen::Vector3f::Constant(0.5f)).cast<std::uint8_t>();
  }
}

/// What was seen, with narrow gaps closed and without the teeth of its rim.
std::vector<char> observedMarks(const mesh::TriangleMesh& mesh, const SurfaceOptions& options)
{
  const std::vector<char> seen(mesh.seen.begin(), mesh.seen.end());
  return openedMarks(mesh, closedMarks(mesh, seen, GAP_RATIO * options.max_support_distance_m),
                     TEETH_RATIO * options.resolution_m);
}
}  // namespace

std::vector<std::string> SurfaceOptions::violations() const
{
  base::OptionsCheck check("surface_reconstruction");
  check.inRange("resolution_m", resolution_m, 1e-4, 0.1);
  check.inRange("max_support_distance_m", max_support_distance_m, 1e-4, 0.5);
  check.inRange("max_decimation_error_m", max_decimation_error_m, 1e-6, 0.1);
  return check.violations();
}

SurfaceResult reconstructSurface(const fusion::FusedCloud& cloud, const std::optional<geometry::Plane>& support,
                                 const SurfaceOptions& options, base::JobControl& control)
{
  base::checked(options);
  control.report("mesh", 0, STAGES);
  SurfaceResult result;
  if (cloud.size() < MIN_POINTS)
  {
    result.status = { base::StatusCode::NO_RESULT, "no surface: the fused cloud has " + std::to_string(cloud.size()) +
                                                       " points, at least " + std::to_string(MIN_POINTS) +
                                                       " are needed; record more views of the object" };
    return result;
  }
  std::vector<Eigen::Vector3f> points = cloud.points, normals = cloud.normals;
  if (options.watertight && support)
    addBase(*support, options.resolution_m, &points, &normals);
  const std::vector<float> spread_m = spreadOfWalls_m(points, normals, geometry::PointIndex(points),
                                                      static_cast<float>(WALL_RATIO * options.resolution_m));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] += spread_m[i] * normals[i];
  mesh::TriangleMesh mesh = poissonSurface(points, normals, CELL_RATIO * options.resolution_m);
  closeTinyHoles(MAX_TINY_EDGES, &mesh);
  removeDegenerateTriangles(&mesh);
  mesh::computeNormals(&mesh);
  takeSpreadBack(points, normals, spread_m, &mesh);

  control.report("mesh", 1, STAGES);
  const geometry::PointIndex index(cloud.points);
  mesh.seen.resize(mesh.vertices.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(mesh.seen.size()); ++i)
    mesh.seen[i] = supported(mesh.vertices[i], mesh.normals[i], cloud, index, options);

  control.report("mesh", 2, STAGES);
  if (!options.watertight)
  {
    keepVertices(observedMarks(mesh, options), &mesh);
    mesh.seen.clear();
  }
  removeSmallPieces(MIN_PIECE_RATIO, &mesh);
  splitTouchingFans(&mesh);
  if (mesh.empty())
  {
    result.status = { base::StatusCode::NO_RESULT,
                      "no surface: none of it lies within max_support_distance_m of a fused point; raise it or "
                      "resolution_m" };
    return result;
  }

  control.report("mesh", 3, STAGES);
  if (options.max_triangles > 0)
  {
    const mesh::DecimationResult decimated =
        mesh::decimate(mesh, { options.max_triangles, options.max_decimation_error_m });
    mesh = decimated.mesh;
    result.warning = decimated.status.message;
  }
  mesh::computeNormals(&mesh);
  if (cloud.colors.size() == cloud.size())
    colorFromCloud(cloud, index, &mesh);
  control.report("mesh", STAGES, STAGES);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace object_modelling::surface
