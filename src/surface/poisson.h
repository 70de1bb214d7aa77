#pragma once

#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::surface
{
/// Closed surface through oriented points (Kazhdan & Hoppe: Screened Poisson Surface Reconstruction, 2013) with cells
/// of about `cell_size_m`. It is closed where there are no points, too. Vertices and triangles only.
mesh::TriangleMesh poissonSurface(const std::vector<Eigen::Vector3f>& points,
                                  const std::vector<Eigen::Vector3f>& normals, double cell_size_m);

}  // namespace object_modelling::surface
