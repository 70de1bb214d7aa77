#pragma once

#include <cstdint>
#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
struct SurfaceSample
{
  std::uint32_t triangle = 0;
  Eigen::Vector3d shares = Eigen::Vector3d::Zero();  ///< of the triangle's corners, 1 in all
};

/// Some `count` places spread evenly over the area, the same ones every time; none without area.
std::vector<SurfaceSample> sampleEvenly(const TriangleMesh& mesh, std::size_t count);

Eigen::Vector3d pointAt(const TriangleMesh& mesh, const SurfaceSample& sample);

}  // namespace object_modelling::mesh
