#pragma once

#include "object_modelling/mesh/mesh_renderer.h"
#include "object_modelling/mesh/textured_mesh.h"

namespace object_modelling::mesh
{
/// As renderMesh, with the colours of the texture as they are (no light). Colours are the mean over a pixel's area,
/// from samples_per_side squared samples; depth and triangle are those of its centre.
MeshView renderTexturedMesh(const TexturedMesh& textured, const geometry::PinholeCamera& camera,
                            const Eigen::Isometry3d& T_camera_model, int samples_per_side = 2,
                            const cv::Scalar& background = { 255, 255, 255 });

/// As the picture of a mesh, with texture.
cv::Mat renderFourSides(const TexturedMesh& textured, int tile_size_px = 480);
cv::Mat renderTurntable(const TexturedMesh& textured, int count, int tile_size_px = 320);

}  // namespace object_modelling::mesh
