#include "object_modelling/mesh/mesh_check.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "object_modelling/base/disjoint_sets.h"
#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct EdgeUse
{
  int forwards = 0, backwards = 0;  ///< from the smaller vertex to the larger, and the other way
};

void checkIndices(const TriangleMesh& mesh)
{
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices.size())
        throw base::Error(base::StatusCode::INVALID_ARGUMENT, "mesh has a triangle of vertex " +
                                                                  std::to_string(vertex) + ", but only " +
                                                                  std::to_string(mesh.vertices.size()) + " vertices");
}

/// Triangles round a vertex that hang together by its edges are one fan.
std::size_t countTouchingFans(const TriangleMesh& mesh)
{
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t])
      around[vertex].push_back(t);
  std::size_t touching = 0;
  for (std::uint32_t vertex = 0; vertex < around.size(); ++vertex)
  {
    base::DisjointSets fans(around[vertex].size());
    std::map<std::uint32_t, std::uint32_t> fan_of;
    for (std::uint32_t i = 0; i < around[vertex].size(); ++i)
      for (const std::uint32_t other : mesh.triangles[around[vertex][i]])
        if (other != vertex)
          fans.unite(i, fan_of.emplace(other, i).first->second);
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < around[vertex].size(); ++i)
      count += fans.find(i) == i;
    touching += count > 1;
  }
  return touching;
}
}  // namespace

MeshCheck checkMesh(const TriangleMesh& mesh)
{
  checkIndices(mesh);
  MeshCheck check;
  std::map<Edge, EdgeUse> edges;
  base::DisjointSets pieces(mesh.vertices.size());
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles)
  {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>(), b = mesh.vertices[triangle[1]].cast<double>(),
                          c = mesh.vertices[triangle[2]].cast<double>();
    check.degenerate_triangle_count += !((b - a).cross(c - a).norm() > 0);
    check.volume_m3 += a.dot(b.cross(c)) / 6;
    for (int k = 0; k < 3; ++k)
    {
      const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
      EdgeUse& use = edges[std::minmax(from, to)];
      ++(from < to ? use.forwards : use.backwards);
      pieces.unite(from, to);
      used[from] = 1;
    }
  }
  for (const auto& [edge, use] : edges)
  {
    const int count = use.forwards + use.backwards;
    check.boundary_edge_count += count == 1;
    check.non_manifold_edge_count += count > 2;
    check.misoriented_edge_count += count == 2 && use.forwards != 1;
  }
  for (std::uint32_t i = 0; i < used.size(); ++i)
    check.piece_count += used[i] != 0 && pieces.find(i) == i;
  check.non_manifold_vertex_count = countTouchingFans(mesh);
  return check;
}

}  // namespace object_modelling::mesh
