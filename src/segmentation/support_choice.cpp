#include "support_choice.h"

#include <algorithm>
#include <cmath>

#include "support_extent.h"

namespace object_modelling::segmentation
{
namespace
{
/// The point in the middle of what the middle of the view shows; by depth, so that it lies on a surface.
bool viewCenter(const rgbd::Frame& frame, Eigen::Vector3d* p_camera)
{
  const int width = frame.depth_m.cols, height = frame.depth_m.rows;
  std::vector<std::pair<float, int>> depths;
  for (int reach = 10; reach >= 2 && depths.empty(); reach /= 2)
    for (int v = height / 2 - height / reach / 2; v < height / 2 + height / reach / 2; ++v)
      for (int u = width / 2 - width / reach / 2; u < width / 2 + width / reach / 2; ++u)
        if (std::isfinite(frame.depthAt_m(u, v)))
          depths.emplace_back(frame.depthAt_m(u, v), v * width + u);
  if (depths.empty())
    return false;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  *p_camera = frame.point(middle->second % width, middle->second / width).cast<double>();
  return true;
}

}  // namespace

std::vector<int> rankSupports(const WorkingImage& image, const GrownPlanes& planes, double max_height_m)
{
  Eigen::Vector3d p_center;
  const bool has_center = viewCenter(image.frame, &p_center);
  std::vector<std::pair<double, int>> ranked;
  for (std::size_t i = 0; i < planes.planes.size(); ++i)
  {
    const geometry::Plane& plane = planes.planes[i].plane;
    // Image-up share of the normal: cos(elevation) for a table in a level camera, -sin(elevation) for a wall. The ramp
    // leaves a camera that looks straight down, or is held upright, its table.
    const double up = -plane.normal.y();
    double score = planes.planes[i].moments.count * std::clamp((up + 0.35) / 0.6, 0.03, 1.0);
    if (has_center)
    {
      const double height_m = plane.signedDistance_m(p_center);
      const double tolerance_m = 0.01 + 0.02 * p_center.z();
      if (height_m < -tolerance_m || height_m > max_height_m)
        score *= 0.1;
      else if (!SupportExtent(image, planes, static_cast<int>(i)).carries(p_center, tolerance_m))
        score *= 0.3;
    }
    ranked.emplace_back(-score, static_cast<int>(i));
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> order;
  for (const auto& [negative_score, index] : ranked)
    order.push_back(index);
  return order;
}

bool liesAbove(const GrownPlane& upper, const GrownPlane& lower)
{
  constexpr double MAX_TILT_COS = 0.966;  // 15 deg
  return upper.plane.normal.dot(lower.plane.normal) > MAX_TILT_COS &&
         lower.plane.signedDistance_m(upper.moments.mean()) > 0;
}

}  // namespace object_modelling::segmentation
