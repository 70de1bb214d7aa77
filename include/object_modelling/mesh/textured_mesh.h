#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
/// A mesh whose triangles have their places on one texture image.
struct TexturedMesh
{
  TriangleMesh mesh;
  /// Per triangle and corner, within [0, 1]: u to the right, v up, (0, 0) the lower left corner of the image (as OBJ;
  /// glTF counts v down).
  std::vector<std::array<Eigen::Vector2f, 3>> uvs;
  cv::Mat texture_bgr;  ///< CV_8UC3
  cv::Mat seen;  ///< CV_8UC1, 255 where a camera saw the surface, 0 where the colour was filled in or no surface is

  bool empty() const { return mesh.empty() || texture_bgr.empty(); }
  /// Place in texels, (0, 0) the centre of the upper left one.
  Eigen::Vector2f texel(const Eigen::Vector2f& uv) const
  {
    return { uv.x() * static_cast<float>(texture_bgr.cols) - 0.5f,
             (1 - uv.y()) * static_cast<float>(texture_bgr.rows) - 0.5f };
  }
};

}  // namespace object_modelling::mesh
