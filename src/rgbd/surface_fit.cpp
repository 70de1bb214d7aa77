#include "object_modelling/rgbd/surface_fit.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::rgbd
{
std::optional<SurfacePoint> fitSurface(const Frame& frame, const Eigen::Vector2d& pixel, const NormalOptions& options)
{
  const int u = static_cast<int>(std::lround(pixel.x()));
  const int v = static_cast<int>(std::lround(pixel.y()));
  const int radius = options.radius_px;
  if (u < radius || v < radius || u >= frame.depth_m.cols - radius || v >= frame.depth_m.rows - radius)
    return std::nullopt;
  const float center_m = frame.depthAt_m(u, v);
  if (!(center_m > 0))
    return std::nullopt;
  const float gate_m = static_cast<float>(options.max_depth_step_ratio) * center_m;
  // Moments about the sub-pixel position, of w = w0 + a du + b dv.
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, w = 0, xw = 0, yw = 0;
  for (int dv = -radius; dv <= radius; ++dv)
  {
    const float* row = frame.depth_m.ptr<float>(v + dv);
    const double dy = v + dv - pixel.y();
    for (int column = u - radius; column <= u + radius; ++column)
    {
      // NaN fails the test.
      if (!(std::abs(row[column] - center_m) <= gate_m))
        continue;
      const double dx = column - pixel.x();
      const double inverse = 1.0 / row[column];
      n += 1;
      x += dx;
      y += dy;
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
      w += inverse;
      xw += dx * inverse;
      yw += dy * inverse;
    }
  }
  if (n < options.min_neighbors + 1)
    return std::nullopt;
  const double mean_x = x / n, mean_y = y / n, mean_w = w / n;
  const double c_xx = xx / n - mean_x * mean_x, c_xy = xy / n - mean_x * mean_y, c_yy = yy / n - mean_y * mean_y;
  const double c_xw = xw / n - mean_x * mean_w, c_yw = yw / n - mean_y * mean_w;
  const double determinant = c_xx * c_yy - c_xy * c_xy;
  // Pixels of one line leave the plane free to turn about it.
  if (determinant < 0.02 * (c_xx + c_yy) * (c_xx + c_yy))
    return std::nullopt;
  const double a = (c_xw * c_yy - c_yw * c_xy) / determinant;
  const double b = (c_yw * c_xx - c_xw * c_xy) / determinant;
  const double inverse_m = mean_w - a * mean_x - b * mean_y;
  if (!(inverse_m > 0))
    return std::nullopt;
  const geometry::PinholeCamera& camera = frame.camera;
  const Eigen::Vector3d direction(a * camera.fx, b * camera.fy,
                                  inverse_m + a * (camera.cx - pixel.x()) + b * (camera.cy - pixel.y()));
  return SurfacePoint{ camera.unproject(pixel.x(), pixel.y(), 1 / inverse_m), -direction.normalized() };
}

}  // namespace object_modelling::rgbd
