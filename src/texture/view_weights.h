#pragma once

#include <vector>

#include "object_modelling/texture/texture_view.h"

namespace object_modelling::texture
{
/// What one view shows of one vertex.
struct VertexView
{
  int view = -1;
  float weight = 0;  ///< > 0
};

/// Per vertex the views that see it, by ascending index.
using VertexWeights = std::vector<std::vector<VertexView>>;

/// Quality of sight times sharpness: a view whose image varies less than those of other views at the same places is
/// blurred and counts less.
VertexWeights weighViews(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views);

struct Exposure;
/// Takes weight from views that disagree with what the others agree on (after the gains, gray levels).
void outvoteOutliers(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views, const Exposure& exposure,
                     double tolerance, VertexWeights* weights);

/// Lets the weight of every view fade towards places that it does not see, over some rings of vertices.
void fadeAtBorders(const mesh::TriangleMesh& mesh, std::size_t view_count, VertexWeights* weights);

}  // namespace object_modelling::texture
