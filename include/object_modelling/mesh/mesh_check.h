#pragma once

#include <cstddef>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
/// What a mesh is, counted. An oriented manifold with boundary has no edge of more than two triangles, no two
/// neighbours that run through their edge in the same direction, and one disk or half disk round every vertex.
struct MeshCheck
{
  std::size_t piece_count = 0;
  std::size_t boundary_edge_count = 0;
  std::size_t non_manifold_edge_count = 0;  ///< of more than two triangles
  std::size_t misoriented_edge_count = 0;   ///< of two triangles, one of which is inside out against the other
  std::size_t non_manifold_vertex_count = 0;
  std::size_t degenerate_triangle_count = 0;  ///< without area, or with a vertex twice
  /// Of what the mesh encloses; negative if its normals point inwards. Means something for closed meshes only.
  double volume_m3 = 0;

  bool manifold() const
  {
    return non_manifold_edge_count == 0 && misoriented_edge_count == 0 && non_manifold_vertex_count == 0 &&
           degenerate_triangle_count == 0;
  }
  bool watertight() const { return manifold() && boundary_edge_count == 0 && volume_m3 > 0; }
};

/// Throws base::Error (INVALID_ARGUMENT) for triangles of vertices that do not exist.
MeshCheck checkMesh(const TriangleMesh& mesh);

}  // namespace object_modelling::mesh
