#include "hull_regions.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <opencv2/imgproc.hpp>

#include "object_modelling/geometry/convex_hull.h"
#include "object_modelling/mesh/mesh_topology.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr double FLAT_RATIO = 1e-6;  // of the height: how far outside of a region's edge still counts as over it

/// Hull with everything relative to the centre of mass.
struct Hull
{
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  mesh::TriangleNeighbors neighbors;
  std::vector<Eigen::Vector3d> area_normals;  ///< per triangle, as long as twice its area
};

Hull hullAbout(const Eigen::Vector3d& center, const std::vector<Eigen::Vector3f>& points)
{
  mesh::TriangleMesh surface;
  const geometry::HullSurface facets = geometry::hullSurface(points);
  surface.vertices = facets.vertices;
  surface.triangles = facets.triangles;
  Hull hull{ {}, surface.triangles, mesh::triangleNeighbors(surface), {} };
  for (const Eigen::Vector3f& vertex : surface.vertices)
    hull.vertices.emplace_back(vertex.cast<double>() - center);
  for (const auto& [a, b, c] : hull.triangles)
    hull.area_normals.push_back((hull.vertices[b] - hull.vertices[a]).cross(hull.vertices[c] - hull.vertices[a]));
  return hull;
}

/// Region of every triangle, grown from the largest ones.
std::vector<int> grow(const Hull& hull, double max_rad, int* count)
{
  std::vector<std::size_t> order(hull.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b)
                   { return hull.area_normals[a].squaredNorm() > hull.area_normals[b].squaredNorm(); });
  std::vector<int> region(hull.triangles.size(), -1);
  const double min_cosine = std::cos(max_rad) - 1e-12;
  *count = 0;
  for (const std::size_t seed : order)
  {
    if (region[seed] >= 0)
      continue;
    const Eigen::Vector3d normal = hull.area_normals[seed].normalized();
    std::vector<std::size_t> front{ seed };
    region[seed] = *count;
    while (!front.empty())
    {
      const std::size_t triangle = front.back();
      front.pop_back();
      for (const int beyond : hull.neighbors[triangle])
      {
        const auto next = static_cast<std::size_t>(beyond);
        if (beyond < 0 || region[next] >= 0 || hull.area_normals[next].normalized().dot(normal) < min_cosine)
          continue;
        region[next] = *count;
        front.push_back(next);
      }
    }
    ++*count;
  }
  return region;
}

/// Of a triangle seen from the origin, as a share of the sphere (van Oosterom and Strackee 1983).
double solidAngleRatio(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
  return 2 * std::atan2(a.dot(b.cross(c)), denominator) / (4 * M_PI);
}

double distanceToEdge_m(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  const Eigen::Vector3d along = b - a;
  const double share = std::clamp(-a.dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (a + share * along).norm();
}

/// Whether the foot of the perpendicular from the origin is within the corners' outline.
bool standsOver(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& normal, double height_m)
{
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<cv::Point2f> flat, outline;
  for (const Eigen::Vector3d& corner : corners)
    flat.emplace_back(static_cast<float>(corner.dot(u) / height_m), static_cast<float>(corner.dot(v) / height_m));
  cv::convexHull(flat, outline);
  return outline.size() > 2 && cv::pointPolygonTest(outline, { 0, 0 }, true) >= -FLAT_RATIO;
}

void addBorders(const Hull& hull, const std::vector<int>& region_of, std::vector<HullRegion>* regions)
{
  for (std::size_t t = 0; t < hull.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int beyond = hull.neighbors[t][i];
      if (beyond < 0 || region_of[static_cast<std::size_t>(beyond)] == region_of[t])
        continue;
      HullRegion& region = (*regions)[static_cast<std::size_t>(region_of[t])];
      const Eigen::Vector3d& a = hull.vertices[hull.triangles[t][i]];
      const Eigen::Vector3d& b = hull.vertices[hull.triangles[t][(i + 1) % 3]];
      const Eigen::Vector3d outward = (b - a).cross(region.normal).normalized();
      region.borders.push_back({ static_cast<std::size_t>(region_of[static_cast<std::size_t>(beyond)]), -a.dot(outward),
                                 distanceToEdge_m(a, b) });
    }
}
}  // namespace

std::vector<HullRegion> hullRegions(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& center_of_mass_m,
                                    double max_coplanar_rad)
{
  const Hull hull = hullAbout(center_of_mass_m, points);
  int count = 0;
  const std::vector<int> region_of = grow(hull, max_coplanar_rad, &count);
  std::vector<HullRegion> regions(static_cast<std::size_t>(count));
  std::vector<std::vector<Eigen::Vector3d>> corners(regions.size());
  for (std::size_t t = 0; t < hull.triangles.size(); ++t)
  {
    const auto r = static_cast<std::size_t>(region_of[t]);
    regions[r].normal += hull.area_normals[t];
    const auto& [a, b, c] = hull.triangles[t];
    regions[r].solid_angle_ratio += solidAngleRatio(hull.vertices[a], hull.vertices[b], hull.vertices[c]);
    for (const std::uint32_t corner : hull.triangles[t])
      corners[r].push_back(hull.vertices[corner]);
  }
  for (std::size_t r = 0; r < regions.size(); ++r)
  {
    regions[r].normal.normalize();
    for (const Eigen::Vector3d& vertex : hull.vertices)
      regions[r].height_m = std::max(regions[r].height_m, vertex.dot(regions[r].normal));
    regions[r].stable = regions[r].height_m > 0 && standsOver(corners[r], regions[r].normal, regions[r].height_m);
  }
  addBorders(hull, region_of, &regions);
  return regions;
}

}  // namespace object_modelling::object_properties
