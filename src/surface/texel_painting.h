#pragma once

#include <vector>

#include "atlas.h"
#include "view_weights.h"

namespace object_modelling::surface
{
/// What a texture is made of; refers to what the caller keeps.
struct Paint
{
  const geometry::TriangleMesh& mesh;
  const std::vector<TextureView>& views;
  const VertexWeights& weights;
  const std::vector<Eigen::Vector3f>& gains;
  const std::vector<Eigen::Vector3f>& vertex_colors;  ///< BGR, for what no view sees
  double view_preference = 1;
};

/// Paints all texels; those within padding_px of a chart repeat its rim.
void paintAtlas(const Paint& paint, const Atlas& atlas, int padding_px, cv::Mat* texture_bgr, cv::Mat* seen);

}  // namespace object_modelling::surface
