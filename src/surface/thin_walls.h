#pragma once

#include <vector>

#include <Eigen/Core>

#include "object_modelling/geometry/point_index.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::surface
{
/// How far to move each point along its normal so that the two sides of a wall are `min_thickness_m` apart, m: 0 where
/// they are, or where there is one side only; smooth along the surface. `normals` point outwards.
std::vector<float> spreadOfWalls_m(const std::vector<Eigen::Vector3f>& points,
                                   const std::vector<Eigen::Vector3f>& normals, const geometry::PointIndex& index,
                                   float min_thickness_m);

/// Takes a mesh of spread points back: vertices move as the spread points round them, of their side, have moved. Needs
/// the mesh's normals, and makes them anew.
void takeSpreadBack(const std::vector<Eigen::Vector3f>& spread_points, const std::vector<Eigen::Vector3f>& normals,
                    const std::vector<float>& spread_m, mesh::TriangleMesh* mesh);

}  // namespace object_modelling::surface
