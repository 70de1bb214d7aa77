#include "solids.h"

#include <cmath>
#include <map>
#include <tuple>

#include "support/shapes.h"

namespace object_modelling::object_properties
{
namespace
{
mesh::TriangleMesh joined(const mesh::TriangleMesh& mesh)
{
  mesh::TriangleMesh result;
  std::map<std::tuple<int, int, int>, std::uint32_t> known;
  std::vector<std::uint32_t> index;
  for (const Eigen::Vector3f& v : mesh.vertices)
  {
    const Eigen::Vector3i key = (v * 1e6f).array().round().cast<int>();
    const auto next = static_cast<std::uint32_t>(result.vertices.size());
    const auto [place, added] = known.insert({ { key.x(), key.y(), key.z() }, next });
    if (added)
      result.vertices.push_back(v);
    index.push_back(place->second);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    if (index[a] != index[b] && index[b] != index[c] && index[c] != index[a])
      result.triangles.push_back({ index[a], index[b], index[c] });
  return result;
}

/// An outline (r, z), outside to its left when run through, turned about z.
mesh::TriangleMesh turnedAboutZ(const std::vector<Eigen::Vector2f>& outline, int sides)
{
  mesh::TriangleMesh mesh;
  for (int side = 0; side < sides; ++side)
    for (const Eigen::Vector2f& p : outline)
    {
      const double turn = 2 * M_PI * side / sides;
      mesh.vertices.emplace_back(p.x() * static_cast<float>(std::cos(turn)), p.x() * static_cast<float>(std::sin(turn)),
                                 p.y());
    }
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t side = 0; side < static_cast<std::uint32_t>(sides); ++side)
    for (std::uint32_t i = 0; i + 1 < n; ++i)
    {
      const std::uint32_t a = side * n + i, b = (side + 1) % static_cast<std::uint32_t>(sides) * n + i;
      mesh.triangles.push_back({ a, b, b + 1 });
      mesh.triangles.push_back({ a, b + 1, a + 1 });
    }
  return joined(mesh);
}

void append(const mesh::TriangleMesh& part, mesh::TriangleMesh* mesh)
{
  const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles)
    mesh->triangles.push_back({ a + first, b + first, c + first });
}
}  // namespace

mesh::TriangleMesh boxAt(const Eigen::Vector3f& low, const Eigen::Vector3f& size_m, int squares)
{
  mesh::TriangleMesh mesh;
  test_support::addBox(low, size_m, squares, &mesh);
  return joined(mesh);
}

mesh::TriangleMesh box(const Eigen::Vector3f& size_m, int squares)
{
  return boxAt(-size_m / 2, size_m, squares);
}

mesh::TriangleMesh cylinder(float radius_m, float height_m, int sides)
{
  const float h = height_m / 2;
  return turnedAboutZ({ { 0, -h }, { radius_m, -h }, { radius_m, h }, { 0, h } }, sides);
}

mesh::TriangleMesh ball(float radius_m)
{
  return joined(test_support::sphere(radius_m, 24));
}

mesh::TriangleMesh mug(bool with_handle)
{
  mesh::TriangleMesh mesh = turnedAboutZ(
      { { 0, -0.05f }, { 0.04f, -0.05f }, { 0.04f, 0.05f }, { 0.036f, 0.05f }, { 0.036f, -0.046f }, { 0, -0.046f } },
      64);
  if (with_handle)
  {
    append(boxAt({ 0.039f, -0.006f, -0.03f }, { 0.026f, 0.012f, 0.008f }, 4), &mesh);
    append(boxAt({ 0.039f, -0.006f, 0.022f }, { 0.026f, 0.012f, 0.008f }, 4), &mesh);
    append(boxAt({ 0.058f, -0.006f, -0.022f }, { 0.007f, 0.012f, 0.044f }, 4), &mesh);
  }
  return mesh;
}

Eigen::Isometry3d awry()
{
  return test_support::farAway();
}

void paint(const Eigen::Vector3i& color_rgb, mesh::TriangleMesh* mesh)
{
  mesh->colors.assign(mesh->vertices.size(), color_rgb.cast<std::uint8_t>());
}

}  // namespace object_modelling::object_properties
