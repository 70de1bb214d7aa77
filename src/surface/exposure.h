#pragma once

#include <vector>

#include "view_weights.h"

namespace object_modelling::surface
{
/// Gain per view and channel (BGR) that brings all views of a place to the same colour: least squares over the
/// logarithms at the vertices, the colour of every vertex eliminated, reweighted against highlights; a weak prior
/// towards 1; geometric mean 1. Values near black and white do not count.
std::vector<Eigen::Vector3f> solveGains(const geometry::TriangleMesh& mesh, const std::vector<TextureView>& views,
                                        const VertexWeights& weights);

}  // namespace object_modelling::surface
