#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/geometry/plane.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::surface
{
struct SurfaceOptions
{
  double resolution_m = 0.002;  ///< detail that is kept; edges are about half as long
  double max_support_distance_m =
      0.006;                      ///< surface further than this from any fused point was not seen and is cut off
  bool watertight = false;        ///< keep the surface closed; what was not seen is marked (TriangleMesh::seen)
  std::size_t max_triangles = 0;  ///< fewer triangles than the reconstruction's; 0: as it is
  double max_decimation_error_m = 0.0003;  ///< that no vertex that goes is further from the surface that stays
  std::vector<std::string> violations() const;
};

struct SurfaceResult
{
  base::Status status;  ///< NO_RESULT: too few points for a surface
  /// With normals and vertex colours, in the cloud's frame; an oriented manifold of the observed surface, or all round.
  mesh::TriangleMesh mesh;
  std::string warning;  ///< empty, or what could not be done as asked for
};

/// Poisson reconstruction (Kazhdan & Hoppe 2013, by PCL), cropped where nothing was seen. Where the object stood on a
/// `support`, a closed surface ends there.
SurfaceResult reconstructSurface(const fusion::FusedCloud& cloud, const std::optional<geometry::Plane>& support,
                                 const SurfaceOptions& options, base::JobControl& control);

}  // namespace object_modelling::surface
