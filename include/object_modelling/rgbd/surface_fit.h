#pragma once

#include <optional>

#include <Eigen/Core>

#include "object_modelling/rgbd/frame.h"
#include "object_modelling/rgbd/normals.h"

namespace object_modelling::rgbd
{
/// The surface at one place of a depth image.
struct SurfacePoint
{
  Eigen::Vector3d p;  ///< on the ray of the pixel, optical frame
  Eigen::Vector3d n;  ///< unit normal, towards the camera
};

/// Plane through the window round a sub-pixel position, fitted to inverse depth as in computeNormals(), for when a few
/// places are wanted and not the whole image. The depth comes from the fit as well: it has less noise than a reading.
/// Nothing where depth is missing, at the rim, or where too few neighbours belong to the same surface.
std::optional<SurfacePoint> fitSurface(const Frame& frame, const Eigen::Vector2d& pixel,
                                       const NormalOptions& options = {});

}  // namespace object_modelling::rgbd
