#pragma once

#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::surface
{
/// Keeps the triangles all of whose vertices are kept, and no vertex that none of them uses. Vertices keep their order.
void keepVertices(const std::vector<char>& keep, mesh::TriangleMesh* mesh);

/// Removes triangles without area, with a vertex twice, or that are there already (in whatever direction).
void removeDegenerateTriangles(mesh::TriangleMesh* mesh);

/// Removes connected pieces with less than this share of the largest one's area.
void removeSmallPieces(double min_area_ratio, mesh::TriangleMesh* mesh);

/// Doubles vertices in which several fans of triangles touch, so that the surface round every vertex is one disk or
/// half disk.
void splitTouchingFans(mesh::TriangleMesh* mesh);

}  // namespace object_modelling::surface
