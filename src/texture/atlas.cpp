#include "atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "object_modelling/base/status.h"

namespace object_modelling::texture
{
namespace
{
constexpr double GROWTH = 1.1;  ///< of the texels, per attempt
constexpr double FILL = 0.85;   ///< of the image, expected
constexpr int SIZE_STEP_PX = 4;

struct Packing
{
  cv::Size size_px;
  std::vector<cv::Point> corner_px;  ///< per chart, upper left of its first texel
};

std::vector<cv::Size> chartSizes(const std::vector<Chart>& charts, double texel_size_m)
{
  std::vector<cv::Size> sizes;
  for (const Chart& chart : charts)
    sizes.emplace_back(static_cast<int>(std::ceil(chart.size_m.x() / texel_size_m)) + 1,
                       static_cast<int>(std::ceil(chart.size_m.y() / texel_size_m)) + 1);
  return sizes;
}

int roundedUp(int value)
{
  return (value + SIZE_STEP_PX - 1) / SIZE_STEP_PX * SIZE_STEP_PX;
}

Packing pack(const std::vector<cv::Size>& sizes, int padding_px)
{
  double area = 0;
  int widest = 0;
  for (const cv::Size& size : sizes)
  {
    area += static_cast<double>(size.width + 2 * padding_px) * (size.height + 2 * padding_px);
    widest = std::max(widest, size.width + 2 * padding_px);
  }
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a].height > sizes[b].height; });
  Packing packing;
  packing.corner_px.resize(sizes.size());
  const int width = roundedUp(std::max(widest, static_cast<int>(std::ceil(std::sqrt(area / FILL)))));
  int u = 0, shelf = 0, shelf_height = 0;
  for (const std::size_t i : order)
  {
    const int chart_width = sizes[i].width + 2 * padding_px, chart_height = sizes[i].height + 2 * padding_px;
    if (u + chart_width > width)
    {
      shelf += shelf_height;
      u = shelf_height = 0;
    }
    packing.corner_px[i] = { u + padding_px, shelf + padding_px };
    u += chart_width;
    shelf_height = std::max(shelf_height, chart_height);
  }
  packing.size_px = { width, roundedUp(shelf + shelf_height) };
  return packing;
}
}  // namespace

Atlas packCharts(const std::vector<Chart>& charts, std::size_t triangle_count, double texel_size_m, int padding_px,
                 int max_side_px)
{
  // However large the texels, every chart takes two of them each way, and its padding.
  const double least_side_px = std::sqrt(static_cast<double>(charts.size())) * (2 * padding_px + 2) / FILL;
  Packing packing = pack(chartSizes(charts, texel_size_m), padding_px);
  while (std::max(packing.size_px.width, packing.size_px.height) > max_side_px)
  {
    if (least_side_px > max_side_px)
      throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                        std::to_string(charts.size()) + " charts do not fit into max_atlas_px = " +
                            std::to_string(max_side_px) + ": raise it or lower padding_px");
    texel_size_m *= GROWTH;
    packing = pack(chartSizes(charts, texel_size_m), padding_px);
  }

  Atlas atlas;
  atlas.size_px = packing.size_px;
  atlas.texel_size_m = texel_size_m;
  atlas.texels.resize(triangle_count);
  atlas.chart.assign(triangle_count, -1);
  for (std::size_t c = 0; c < charts.size(); ++c)
    for (std::size_t i = 0; i < charts[c].triangles.size(); ++i)
    {
      const int triangle = charts[c].triangles[i];
      atlas.chart[triangle] = static_cast<int>(c);
      for (int k = 0; k < 3; ++k)
        atlas.texels[triangle][k] =
            charts[c].corners_m[i][k] / static_cast<float>(texel_size_m) +
            Eigen::Vector2f(static_cast<float>(packing.corner_px[c].x), static_cast<float>(packing.corner_px[c].y));
    }
  return atlas;
}

}  // namespace object_modelling::texture
