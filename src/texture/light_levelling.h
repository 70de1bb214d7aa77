#pragma once

#include <vector>

#include "view_weights.h"

namespace object_modelling::texture
{
/// Per light and vertex, what colours under that light (BGR) are multiplied by.
using LightGains = std::vector<std::vector<Eigen::Vector3f>>;

/// Brings recordings under several lights (the object turned over: what was in the shade is lit) to one colour wherever
/// two show the same surface: least squares over the logarithms of the vertices' colours under each light, with gains
/// that change smoothly along the surface and freely across edges of it, reweighted against highlights. Where a single
/// light was, its gains run on. Views are corrected by `view_gains` first. Empty under one light.
LightGains levelLights(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                       const VertexWeights& weights, const std::vector<Eigen::Vector3f>& view_gains);

}  // namespace object_modelling::texture
