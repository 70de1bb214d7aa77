#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
/// Triangle beyond the edge from corner i to corner i + 1, -1 at a border (or where more than two share the edge).
using TriangleNeighbors = std::vector<std::array<int, 3>>;
TriangleNeighbors triangleNeighbors(const TriangleMesh& mesh);

/// Vertices that share an edge with each vertex, ascending, each once.
std::vector<std::vector<std::uint32_t>> vertexNeighbors(const TriangleMesh& mesh);

/// Unit normal of a triangle; zero if it has no area.
Eigen::Vector3f triangleNormal(const TriangleMesh& mesh, std::size_t triangle);

}  // namespace object_modelling::mesh
