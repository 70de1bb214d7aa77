#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "object_modelling/base/status.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
struct DecimationOptions
{
  std::size_t max_triangles = 0;  ///< to aim at; 0: as few as the error allows
  double max_error_m = 0.0003;    ///< no vertex that goes is further from the surface that stays
  std::vector<std::string> violations() const;
};

struct DecimationResult
{
  /// NO_RESULT: the error does not allow as few triangles; the mesh is then the smallest that it allows.
  base::Status status;
  TriangleMesh mesh;
};

/// Fewer triangles by half-edge collapse in the order of the quadric error (Garland and Heckbert 1997), within a
/// Hausdorff bound, by OpenMesh. Vertices that stay keep place, colour and mark; normals are made anew. Wants an
/// oriented manifold; throws base::Error (INVALID_ARGUMENT) for another mesh.
DecimationResult decimate(const TriangleMesh& mesh, const DecimationOptions& options);

}  // namespace object_modelling::mesh
