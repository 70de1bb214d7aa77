#pragma once

#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::surface
{
/// Morphological closing along the surface: the vertices that are marked, and those of gaps between them that are less
/// than twice `reach_m` wide (Serra 1982; distances along edges). What a rim of marked vertices has beyond it stays
/// out.
std::vector<char> closedMarks(const mesh::TriangleMesh& mesh, const std::vector<char>& marks, double reach_m);

/// Morphological opening: without what is less than twice `reach_m` wide, such as the teeth of a ragged rim.
std::vector<char> openedMarks(const mesh::TriangleMesh& mesh, const std::vector<char>& marks, double reach_m);

/// Closes holes with a rim of at most `max_edges`, by triangles between its vertices. What has a longer rim stays open.
void closeTinyHoles(std::size_t max_edges, mesh::TriangleMesh* mesh);

}  // namespace object_modelling::surface
