#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/base/job_control.h"
#include "object_modelling/mesh/textured_mesh.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::texture
{
struct TextureOptions
{
  double texel_size_m = 0.0005;  ///< side of a texel on the surface; grows where the atlas would not fit
  int max_atlas_px = 4096;       ///< longest side of the texture image
  int padding_px = 4;            ///< texels round every chart that repeat its rim, against bleeding when it is minified
  /// How far the best view of a place outweighs the others: a view counts by its quality to the power of this. High:
  /// nearly a single view, its noise and steps included; low: the mean of all views, which blurs.
  double view_preference = 2;
  /// Views whose colour (exposure corrected) is further than this from what the others agree on lose their weight:
  /// highlights, shadows, poses that are off. Gray levels, at a place without texture; more is allowed at edges.
  double outlier_tolerance = 12;
  std::vector<std::string> violations() const;
};

struct TextureResult
{
  base::Status status;  ///< INVALID_ARGUMENT: no triangles; NO_RESULT: no view sees the mesh, the message says why
  mesh::TexturedMesh textured;
  double seen_ratio = 0;  ///< share of the surface's area that a view saw
  std::size_t chart_count = 0;
  double texel_size_m = 0;  ///< as used
  /// Mean step (gray levels) along the borders where the best view of the surface changes: between the two views'
  /// images as they came, and in the texture.
  double seam_step_before = 0, seam_step_after = 0;
  std::vector<Eigen::Vector3f> gains;  ///< per view, what its blue, green and red are multiplied by; 1 where not known
};

/// Paints a mesh with the images of views, whose world is the mesh's frame. Views are weighted at every vertex by
/// resolution, angle, sharpness and distance from the rim of mask and silhouette, without those that are hidden
/// there or disagree with the rest; weights fade where a view ends, so that texels, weighted means over the views, have
/// no seams to be levelled. Exposure and white balance of all views are solved together beforehand; where views of
/// several sessions overlap, each under a light of its own, they are levelled to the same colour. Charts are pieces
/// of surface of about one direction, laid flat. Texels that no view observed are filled in harmonically and marked.
/// Deterministic. In the spirit of Waechter et al. 2014, "Let There Be Color!", with blending in place of single views.
TextureResult textureMesh(const mesh::TriangleMesh& mesh, const std::vector<rgbd::View>& views,
                          const TextureOptions& options, base::JobControl& control);

}  // namespace object_modelling::texture
