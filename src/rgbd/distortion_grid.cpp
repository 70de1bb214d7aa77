#include "object_modelling/rgbd/distortion_grid.h"

#include <algorithm>
#include <vector>

namespace object_modelling::rgbd
{
namespace
{
/// Between which two of `count` knots, evenly over `size_px` pixels, a pixel lies.
struct Between
{
  int first = 0;
  double share_of_second = 0;

  Between(double pixel, int size_px, int count)
  {
    const double x = std::clamp(pixel / std::max(size_px - 1, 1), 0.0, 1.0) * (count - 1);
    first = std::min(static_cast<int>(x), count - 2);
    share_of_second = x - first;
  }
};
}  // namespace

DistortionGrid::Shares DistortionGrid::sharesAt(double u_px, double v_px, int width_px, int height_px)
{
  const Between column(u_px, width_px, COLUMNS), row(v_px, height_px, ROWS);
  const double a = column.share_of_second, b = row.share_of_second;
  const int knot = row.first * COLUMNS + column.first;
  return { { knot, knot + 1, knot + COLUMNS, knot + COLUMNS + 1 },
           { (1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b } };
}

double DistortionGrid::ratioAt(const Ratios& ratios, double u_px, double v_px, int width_px, int height_px)
{
  const Shares around = sharesAt(u_px, v_px, width_px, height_px);
  double ratio = 0;
  for (std::size_t i = 0; i < around.knot.size(); ++i)
    ratio += around.share[i] * ratios[around.knot[i]];
  return ratio;
}

cv::Mat DistortionGrid::image(const Ratios& ratios, const cv::Size& size)
{
  std::vector<Between> columns;
  for (int u = 0; u < size.width; ++u)
    columns.emplace_back(u, size.width, COLUMNS);
  cv::Mat result(size, CV_32FC1);
  for (int v = 0; v < size.height; ++v)
  {
    const Between row(v, size.height, ROWS);
    double knots[COLUMNS];
    for (int i = 0; i < COLUMNS; ++i)
    {
      const double* above = &ratios[row.first * COLUMNS + i];
      knots[i] = above[0] + row.share_of_second * (above[COLUMNS] - above[0]);
    }
    auto* values = result.ptr<float>(v);
    for (int u = 0; u < size.width; ++u)
    {
      const double* left = &knots[columns[u].first];
      values[u] = static_cast<float>(left[0] + columns[u].share_of_second * (left[1] - left[0]));
    }
  }
  return result;
}

}  // namespace object_modelling::rgbd
