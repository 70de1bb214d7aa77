#pragma once

#include <vector>

#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::database
{
/// Marks the mesh's vertices further than `max_distance_m` from every fused point as not seen (TriangleMesh::seen);
/// vertices that are marked so already stay so.
void markSeen(const fusion::FusedCloud& cloud, double max_distance_m, mesh::TriangleMesh* mesh);

/// Standard deviation along the normal of each vertex, m: the mean of the nearest fused points'. NaN where the vertex
/// was not seen. None for a cloud without points.
std::vector<float> sigmasOf(const fusion::FusedCloud& cloud, const mesh::TriangleMesh& mesh);

}  // namespace object_modelling::database
