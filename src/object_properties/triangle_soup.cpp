#include "triangle_soup.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "object_modelling/mesh/mesh_topology.h"
#include "object_modelling/mesh/surface_sampling.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr std::size_t SOUP_SAMPLES = 400;
constexpr double IGNORED_SHARE = 0.02;

/// Below the plane: the corners and where the edges cross it, in their order; three or four, or none.
std::vector<Eigen::Vector3f> cut(const std::array<Eigen::Vector3f, 3>& triangle, int axis, float at_m, int side)
{
  std::vector<Eigen::Vector3f> polygon;
  const auto beyond_m = [&](const Eigen::Vector3f& p) { return static_cast<float>(side) * (p[axis] - at_m); };
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Eigen::Vector3f &a = triangle[i], &b = triangle[(i + 1) % 3];
    const float at_a = beyond_m(a), at_b = beyond_m(b);
    if (at_a >= 0)
      polygon.push_back(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0))
      polygon.emplace_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return polygon;
}

mesh::TriangleMesh meshOf(const Soup& soup)
{
  mesh::TriangleMesh mesh;
  for (const auto& triangle : soup)
  {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), triangle.begin(), triangle.end());
    mesh.triangles.push_back({ first, first + 1, first + 2 });
  }
  return mesh;
}
}  // namespace

Soup soupOf(const mesh::TriangleMesh& mesh)
{
  Soup soup;
  for (const auto& [a, b, c] : mesh.triangles)
    soup.push_back({ mesh.vertices[a], mesh.vertices[b], mesh.vertices[c] });
  return soup;
}

Soup coarsened(const Soup& soup, float cell_m)
{
  const auto keyOf = [&](const Eigen::Vector3f& p)
  {
    const Eigen::Vector3i cell = (p / cell_m).array().floor().cast<int>();
    return std::make_tuple(cell.x(), cell.y(), cell.z());
  };
  std::map<std::tuple<int, int, int>, Eigen::Vector3f> first;  // corner of every cell
  Soup coarse;
  for (const auto& triangle : soup)
  {
    std::array<Eigen::Vector3f, 3> moved;
    for (std::size_t i = 0; i < 3; ++i)
      moved[i] = first.insert({ keyOf(triangle[i]), triangle[i] }).first->second;
    if ((moved[1] - moved[0]).cross(moved[2] - moved[0]).squaredNorm() > 0)
      coarse.push_back(moved);
  }
  return coarse;
}

Soup clipped(const Soup& soup, int axis, float at_m, int side)
{
  Soup result;
  for (const auto& triangle : soup)
  {
    const std::vector<Eigen::Vector3f> polygon = cut(triangle, axis, at_m, side);
    for (std::size_t i = 2; i < polygon.size(); ++i)
      result.push_back({ polygon[0], polygon[i - 1], polygon[i] });
  }
  return result;
}

Soup clipped(const Soup& soup, const Eigen::AlignedBox3f& box)
{
  Soup result = soup;
  for (int axis = 0; axis < 3; ++axis)
    result = clipped(clipped(result, axis, box.min()[axis], 1), axis, box.max()[axis], -1);
  return result;
}

std::vector<Eigen::Vector3f> cornersOf(const Soup& soup)
{
  std::vector<Eigen::Vector3f> corners;
  corners.reserve(3 * soup.size());
  for (const auto& triangle : soup)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  return corners;
}

Hollow deepestHollow(const Soup& soup, const geometry::HullSurface& hull)
{
  std::vector<std::pair<Eigen::Vector3f, float>> planes;  // outward normal, offset
  for (const auto& [a, b, c] : hull.triangles)
  {
    const Eigen::Vector3f &p = hull.vertices[a], &q = hull.vertices[b], &r = hull.vertices[c];
    const Eigen::Vector3f normal = (q - p).cross(r - p).normalized();
    planes.emplace_back(normal, normal.dot(p));
  }
  const mesh::TriangleMesh surface = meshOf(soup);
  std::vector<Hollow> hollows;
  for (const mesh::SurfaceSample& sample : mesh::sampleEvenly(surface, SOUP_SAMPLES))
  {
    const Eigen::Vector3f place = mesh::pointAt(surface, sample).cast<float>();
    const Eigen::Vector3f normal = mesh::triangleNormal(surface, sample.triangle);
    float depth_m = std::numeric_limits<float>::infinity();
    for (const auto& [outward, offset_m] : planes)
      if (outward.dot(normal) > 1e-3f)
        depth_m = std::min(depth_m, (offset_m - outward.dot(place)) / outward.dot(normal));
    if (std::isfinite(depth_m))
      hollows.push_back({ static_cast<double>(depth_m), place, normal });
  }
  if (hollows.empty())
    return {};
  const auto at =
      hollows.begin() + static_cast<std::ptrdiff_t>((1 - IGNORED_SHARE) * static_cast<double>(hollows.size() - 1));
  std::nth_element(hollows.begin(), at, hollows.end(),
                   [](const Hollow& a, const Hollow& b) { return a.depth_m < b.depth_m; });
  return *at;
}

}  // namespace object_modelling::object_properties
