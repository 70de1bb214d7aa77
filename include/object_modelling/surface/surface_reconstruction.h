#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/geometry/triangle_mesh.h"

namespace object_modelling::surface
{
struct SurfaceOptions
{
  double resolution_m = 0.002;  ///< edge length aimed at
  double max_support_distance_m =
      0.006;  ///< surface further than this from any fused point was not seen and is cut off
  std::vector<std::string> violations() const;
};

struct SurfaceResult
{
  base::Status status;          ///< NO_RESULT: too few points for a surface
  geometry::TriangleMesh mesh;  ///< with normals and vertex colours, in the cloud's frame; observed surface only
};

/// Poisson reconstruction (Kazhdan & Hoppe 2013, by PCL), cropped where nothing was seen.
SurfaceResult reconstructSurface(const fusion::FusedCloud& cloud, const SurfaceOptions& options,
                                 base::JobControl& control);

}  // namespace object_modelling::surface
