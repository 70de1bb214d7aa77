#include "closed_base.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace object_modelling::surface
{
namespace
{
// The lowest millimetres are seldom seen: they lie in the fringe of the support's own depth.
constexpr double CONTACT_HEIGHT_M = 0.008;
constexpr std::size_t MIN_CONTACT_POINTS = 10;
}  // namespace

void addBase(const geometry::Plane& support, double step_m, std::vector<Eigen::Vector3f>* points,
             std::vector<Eigen::Vector3f>* normals)
{
  const Eigen::Vector3d up = support.normal, x = up.unitOrthogonal(), y = up.cross(x);
  const Eigen::Vector3d origin = -support.offset_m * up;
  std::vector<cv::Point2f> contact;
  for (const Eigen::Vector3f& point : *points)
  {
    const Eigen::Vector3d p = point.cast<double>() - origin;
    if (p.dot(up) < std::max(CONTACT_HEIGHT_M, 3 * step_m))
      contact.emplace_back(static_cast<float>(p.dot(x)), static_cast<float>(p.dot(y)));
  }
  if (contact.size() < MIN_CONTACT_POINTS)
    return;
  std::vector<cv::Point2f> hull;
  cv::convexHull(contact, hull);
  if (hull.size() < 3)
    return;
  cv::Point2f low = hull.front(), high = hull.front();
  for (const cv::Point2f& corner : hull)
  {
    low = { std::min(low.x, corner.x), std::min(low.y, corner.y) };
    high = { std::max(high.x, corner.x), std::max(high.y, corner.y) };
  }
  const auto step = static_cast<float>(step_m);
  for (float v = low.y; v <= high.y; v += step)
    for (float u = low.x; u <= high.x; u += step)
    {
      if (cv::pointPolygonTest(hull, { u, v }, false) < 0)
        continue;
      points->push_back((origin + static_cast<double>(u) * x + static_cast<double>(v) * y).cast<float>());
      normals->push_back(-up.cast<float>());
    }
}

}  // namespace object_modelling::surface
