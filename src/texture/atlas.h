#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "mesh_charts.h"

namespace object_modelling::texture
{
/// Where the triangles lie on the texture image.
struct Atlas
{
  cv::Size size_px;
  double texel_size_m = 0;
  std::vector<std::array<Eigen::Vector2f, 3>>
      texels;              ///< per triangle and corner, (0, 0) the centre of the first texel
  std::vector<int> chart;  ///< per triangle
};

/// Charts side by side on shelves, the highest first, `padding_px` free texels round each, on an image about square.
/// Where they do not fit into max_side_px the texels grow. Throws base::Error (INVALID_ARGUMENT) if even that does not
/// help.
Atlas packCharts(const std::vector<Chart>& charts, std::size_t triangle_count, double texel_size_m, int padding_px,
                 int max_side_px);

}  // namespace object_modelling::texture
