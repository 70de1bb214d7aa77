#include "mesh_cleaning.h"

#include <algorithm>
#include <array>
#include <set>

#include "object_modelling/base/disjoint_sets.h"

namespace object_modelling::surface
{
namespace
{
float area_m2(const mesh::TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle)
{
  const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
  return 0.5f * (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).norm();
}

}  // namespace

void keepVertices(const std::vector<char>& keep, mesh::TriangleMesh* mesh)
{
  auto& triangles = mesh->triangles;
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(),
                                 [&](const auto& t) { return !keep[t[0]] || !keep[t[1]] || !keep[t[2]]; }),
                  triangles.end());
  constexpr std::uint32_t UNUSED = ~0u;
  std::vector<std::uint32_t> new_index(mesh->vertices.size(), UNUSED);
  for (const auto& triangle : triangles)
  {
    for (const std::uint32_t vertex : triangle)
      new_index[vertex] = 0;
  }
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < new_index.size(); ++i)
  {
    if (new_index[i] == UNUSED)
      continue;
    new_index[i] = count;
    mesh->vertices[count] = mesh->vertices[i];
    if (!mesh->normals.empty())
      mesh->normals[count] = mesh->normals[i];
    if (!mesh->colors.empty())
      mesh->colors[count] = mesh->colors[i];
    if (!mesh->seen.empty())
      mesh->seen[count] = mesh->seen[i];
    ++count;
  }
  mesh->vertices.resize(count);
  if (!mesh->normals.empty())
    mesh->normals.resize(count);
  if (!mesh->colors.empty())
    mesh->colors.resize(count);
  if (!mesh->seen.empty())
    mesh->seen.resize(count);
  for (auto& triangle : triangles)
  {
    for (std::uint32_t& vertex : triangle)
      vertex = new_index[vertex];
  }
}

void removeDegenerateTriangles(mesh::TriangleMesh* mesh)
{
  std::set<std::array<std::uint32_t, 3>> seen;
  auto& triangles = mesh->triangles;
  const auto unwanted = [&](const std::array<std::uint32_t, 3>& triangle)
  {
    std::array<std::uint32_t, 3> sorted = triangle;
    std::sort(sorted.begin(), sorted.end());
    return sorted[0] == sorted[1] || sorted[1] == sorted[2] || !(area_m2(*mesh, triangle) > 0) ||
           !seen.insert(sorted).second;
  };
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), unwanted), triangles.end());
}

void removeSmallPieces(double min_area_ratio, mesh::TriangleMesh* mesh)
{
  base::DisjointSets pieces(mesh->vertices.size());
  for (const auto& triangle : mesh->triangles)
  {
    pieces.unite(triangle[0], triangle[1]);
    pieces.unite(triangle[0], triangle[2]);
  }
  std::vector<double> areas_m2(mesh->vertices.size(), 0);
  for (const auto& triangle : mesh->triangles)
    areas_m2[pieces.find(triangle[0])] += area_m2(*mesh, triangle);
  const double largest_m2 = areas_m2.empty() ? 0 : *std::max_element(areas_m2.begin(), areas_m2.end());
  std::vector<char> keep(mesh->vertices.size());
  for (std::uint32_t i = 0; i < keep.size(); ++i)
    keep[i] = areas_m2[pieces.find(i)] >= min_area_ratio * largest_m2;
  keepVertices(keep, mesh);
}

void splitTouchingFans(mesh::TriangleMesh* mesh)
{
  std::vector<std::vector<std::uint32_t>> triangles_of(mesh->vertices.size());
  for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t)
  {
    for (const std::uint32_t vertex : mesh->triangles[t])
      triangles_of[vertex].push_back(t);
  }
  for (std::uint32_t vertex = 0; vertex < triangles_of.size(); ++vertex)
  {
    const std::vector<std::uint32_t>& around = triangles_of[vertex];
    base::DisjointSets fans(around.size());
    for (std::uint32_t i = 0; i < around.size(); ++i)
    {
      for (std::uint32_t j = 0; j < i; ++j)
      {
        const auto& a = mesh->triangles[around[i]];
        const auto& b = mesh->triangles[around[j]];
        const bool share_edge = std::any_of(
            a.begin(), a.end(),
            [&](std::uint32_t other) { return other != vertex && std::find(b.begin(), b.end(), other) != b.end(); });
        if (share_edge)
          fans.unite(i, j);
      }
    }
    for (std::uint32_t first = 1; first < around.size(); ++first)
    {
      if (fans.find(first) != first)
        continue;
      const auto copy = static_cast<std::uint32_t>(mesh->vertices.size());
      mesh->vertices.push_back(mesh->vertices[vertex]);
      if (!mesh->normals.empty())
        mesh->normals.push_back(mesh->normals[vertex]);
      if (!mesh->colors.empty())
        mesh->colors.push_back(mesh->colors[vertex]);
      if (!mesh->seen.empty())
        mesh->seen.push_back(mesh->seen[vertex]);
      for (std::uint32_t i = first; i < around.size(); ++i)
      {
        if (fans.find(i) == first)
          std::replace(mesh->triangles[around[i]].begin(), mesh->triangles[around[i]].end(), vertex, copy);
      }
    }
  }
}

}  // namespace object_modelling::surface
