#include "mesh_closing.h"

#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "object_modelling/mesh/mesh_topology.h"

namespace object_modelling::surface
{
namespace
{
/// Distance of every vertex along edges to the nearest one that has this mark, as far as `reach_m` (Dijkstra 1959);
/// infinite beyond.
std::vector<double> distances_m(const mesh::TriangleMesh& mesh,
                                const std::vector<std::vector<std::uint32_t>>& neighbors,
                                const std::vector<char>& marks, bool mark, double reach_m)
{
  using Entry = std::pair<double, std::uint32_t>;
  std::vector<double> distance(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
    if ((marks[i] != 0) == mark)
    {
      distance[i] = 0;
      open.emplace(0.0, i);
    }
  while (!open.empty())
  {
    const auto [so_far, i] = open.top();
    open.pop();
    if (so_far > distance[i])
      continue;
    for (const std::uint32_t j : neighbors[i])
    {
      const double through = so_far + (mesh.vertices[j] - mesh.vertices[i]).norm();
      if (through > reach_m || through >= distance[j])
        continue;
      distance[j] = through;
      open.emplace(through, j);
    }
  }
  return distance;
}

/// Marks all within the reach of a vertex that has this mark.
std::vector<char> grown(const mesh::TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& neighbors,
                        const std::vector<char>& marks, bool mark, double reach_m)
{
  const std::vector<double> distance = distances_m(mesh, neighbors, marks, mark, reach_m);
  std::vector<char> result(marks.size());
  for (std::size_t i = 0; i < marks.size(); ++i)
    result[i] = static_cast<char>((distance[i] <= reach_m) == mark);
  return result;
}
}  // namespace

std::vector<char> closedMarks(const mesh::TriangleMesh& mesh, const std::vector<char>& marks, double reach_m)
{
  const auto neighbors = mesh::vertexNeighbors(mesh);
  std::vector<char> result = grown(mesh, neighbors, grown(mesh, neighbors, marks, true, reach_m), false, reach_m);
  for (std::size_t i = 0; i < marks.size(); ++i)  // lengths along edges are not quite the same both ways
    result[i] = static_cast<char>(result[i] || marks[i]);
  return result;
}

std::vector<char> openedMarks(const mesh::TriangleMesh& mesh, const std::vector<char>& marks, double reach_m)
{
  const auto neighbors = mesh::vertexNeighbors(mesh);
  std::vector<char> result = grown(mesh, neighbors, grown(mesh, neighbors, marks, false, reach_m), true, reach_m);
  for (std::size_t i = 0; i < marks.size(); ++i)
    result[i] = static_cast<char>(result[i] && marks[i]);
  return result;
}

void closeTinyHoles(std::size_t max_edges, mesh::TriangleMesh* mesh)
{
  const mesh::TriangleNeighbors neighbors = mesh::triangleNeighbors(*mesh);
  std::map<std::uint32_t, std::uint32_t> next;  // along the rims, as their triangles run
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (neighbors[t][i] < 0)
        next[mesh->triangles[t][i]] = mesh->triangles[t][(i + 1) % 3];
  while (!next.empty())
  {
    std::vector<std::uint32_t> rim;
    const std::uint32_t start = next.begin()->first;
    for (auto at = next.begin(); at != next.end(); at = next.find(rim.back()))
    {
      rim.push_back(at->second);
      next.erase(at);
    }
    if (rim.back() != start || rim.size() < 3 || rim.size() > max_edges)
      continue;
    for (std::size_t i = 1; i + 1 < rim.size(); ++i)
      mesh->triangles.push_back({ rim[0], rim[i + 1], rim[i] });
  }
}

}  // namespace object_modelling::surface
