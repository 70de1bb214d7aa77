#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::texture
{
/// A connected piece of surface laid flat: projected along its mean normal, free of overlaps and turned triangles.
struct Chart
{
  std::vector<int> triangles;                             ///< ascending
  std::vector<std::array<Eigen::Vector2f, 3>> corners_m;  ///< per triangle: place of its corners, x right, y down, >= 0
  Eigen::Vector2f size_m{ 0, 0 };
};

/// Every triangle lands in exactly one chart. Directions are the six of the mesh's axes at first, with smooth borders
/// between them; what does not lie flat that way becomes charts of its own. `raster_m` is the grid on which overlaps
/// are looked for.
std::vector<Chart> makeCharts(const mesh::TriangleMesh& mesh, double raster_m);

}  // namespace object_modelling::texture
