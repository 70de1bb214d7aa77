#pragma once

#include <vector>

#include "atlas.h"
#include "exposure.h"
#include "view_image.h"
#include "view_weights.h"

namespace object_modelling::texture
{
/// What a texture is made of; refers to what the caller keeps.
struct Paint
{
  const mesh::TriangleMesh& mesh;
  const std::vector<TextureView>& views;
  const VertexWeights& weights;
  const Exposure& exposure;
  double view_preference = 1;
};

/// The triangle that each texel belongs to, -1 for none. Texels on an edge belong to the first of its triangles, those
/// that touch a chart from outside to that of a neighbour: filtering reads them at the chart's border.
struct TexelOwners
{
  cv::Mat triangle;  ///< CV_32SC1
  cv::Mat inside;    ///< CV_8UC1: within a chart, not beside it
};
TexelOwners findOwners(const Atlas& atlas);

/// Weighted mean of the views' images at every texel, CV_32FC3; `vertex_colors` (BGR) where no view sees it, zero
/// without. Texels within padding_px of a chart repeat its rim.
cv::Mat paintAtlas(const Paint& paint, const Atlas& atlas, const TexelOwners& owners,
                   const std::vector<ViewImage>& images, const std::vector<Eigen::Vector3f>& vertex_colors,
                   int padding_px);

/// CV_8UC1, 255 at texels within charts that a view sees.
cv::Mat seenTexels(const Paint& paint, const Atlas& atlas, const TexelOwners& owners);

}  // namespace object_modelling::texture
