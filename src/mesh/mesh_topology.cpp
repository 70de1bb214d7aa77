#include "object_modelling/mesh/mesh_topology.h"

#include <algorithm>
#include <utility>

namespace object_modelling::mesh
{
TriangleNeighbors triangleNeighbors(const TriangleMesh& mesh)
{
  struct Side
  {
    std::uint32_t low, high;
    int triangle, corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
    {
      const auto [low, high] = std::minmax(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
      sides.push_back({ low, high, static_cast<int>(t), i });
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b)
            {
              return std::make_pair(a.low, a.high) != std::make_pair(b.low, b.high)
                         ? std::make_pair(a.low, a.high) < std::make_pair(b.low, b.high)
                         : a.triangle < b.triangle;
            });
  TriangleNeighbors neighbors(mesh.triangles.size(), { -1, -1, -1 });
  for (std::size_t i = 0; i < sides.size();)
  {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
      ++end;
    if (end == i + 2)
    {
      neighbors[sides[i].triangle][sides[i].corner] = sides[i + 1].triangle;
      neighbors[sides[i + 1].triangle][sides[i + 1].corner] = sides[i].triangle;
    }
    i = end;
  }
  return neighbors;
}

std::vector<std::vector<std::uint32_t>> vertexNeighbors(const TriangleMesh& mesh)
{
  std::vector<std::vector<std::uint32_t>> neighbors(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles)
    for (int i = 0; i < 3; ++i)
    {
      neighbors[triangle[i]].push_back(triangle[(i + 1) % 3]);
      neighbors[triangle[i]].push_back(triangle[(i + 2) % 3]);
    }
  for (std::vector<std::uint32_t>& of_vertex : neighbors)
  {
    std::sort(of_vertex.begin(), of_vertex.end());
    of_vertex.erase(std::unique(of_vertex.begin(), of_vertex.end()), of_vertex.end());
  }
  return neighbors;
}

Eigen::Vector3f triangleNormal(const TriangleMesh& mesh, std::size_t triangle)
{
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3f normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
  const float length = normal.norm();
  return length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::Zero();
}

}  // namespace object_modelling::mesh
