#pragma once

#include <optional>
#include <vector>

#include "light_levelling.h"
#include "view_weights.h"

namespace object_modelling::texture
{
/// Logarithm of a colour; nothing where it is near black, or a channel near white and clipped. A channel that is near
/// black by itself, as blue is of yellow things, counts as the darkest usable value.
std::optional<Eigen::Vector3f> logColor(const Eigen::Vector3f& bgr);

/// Gain per view and channel (BGR) that brings all views of a place to the same colour: least squares over the
/// logarithms at the vertices, the colour of every vertex eliminated, reweighted against highlights; a weak prior
/// towards 1; geometric mean 1. Values near black and white do not count, and views under different lights do not meet.
std::vector<Eigen::Vector3f> solveGains(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                                        const VertexWeights& weights);

/// What brings all views of a place to the same colour: the gains of their exposure, and of the light.
struct Exposure
{
  std::vector<Eigen::Vector3f> view_gains;
  LightGains light_gains;  ///< empty: all views are under one light

  Eigen::Vector3f ofLight(int light, std::uint32_t vertex) const
  {
    return light_gains.empty() ? Eigen::Vector3f::Ones() : light_gains[light][vertex];
  }
};
Exposure solveExposure(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                       const VertexWeights& weights);

}  // namespace object_modelling::texture
