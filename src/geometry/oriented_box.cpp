#include "object_modelling/geometry/oriented_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <opencv2/imgproc.hpp>

#include "object_modelling/base/statistics.h"
#include "object_modelling/base/status.h"
#include "object_modelling/geometry/convex_hull.h"

namespace object_modelling::geometry
{
namespace
{
struct Interval
{
  double low = 0;
  double high = 0;

  double length() const { return high - low; }
  double center() const { return 0.5 * (low + high); }
};

/// Extent of the values without the `trim` smallest and largest. Reorders them.
Interval extent(std::vector<double>* values, double trim_ratio)
{
  const auto count = static_cast<std::ptrdiff_t>(values->size());
  const std::ptrdiff_t trim =
      std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(trim_ratio * count), (count - 1) / 2);
  if (trim == 0)
  {
    const auto [low, high] = std::minmax_element(values->begin(), values->end());
    return { *low, *high };
  }
  std::nth_element(values->begin(), values->begin() + trim, values->end());
  const double low = (*values)[trim];
  std::nth_element(values->begin() + trim, values->end() - 1 - trim, values->end());
  return { low, *(values->end() - 1 - trim) };
}

Interval extentAlong(double angle, const std::vector<cv::Point2f>& points, double trim_ratio,
                     std::vector<double>* buffer)
{
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  buffer->clear();
  for (const cv::Point2f& p : points)
    buffer->push_back(c * p.x + s * p.y);
  return extent(buffer, trim_ratio);
}

struct Rectangle
{
  double angle_rad = 0;  ///< of its first axis
  Interval first, second;

  double area() const { return first.length() * second.length(); }
};

Rectangle rectangleAt(double angle_rad, const std::vector<cv::Point2f>& points, double trim_ratio,
                      std::vector<double>* buffer)
{
  return { angle_rad, extentAlong(angle_rad, points, trim_ratio, buffer),
           extentAlong(angle_rad + M_PI_2, points, trim_ratio, buffer) };
}

/// The smallest rectangle has a side on an edge of the hull (Freeman and Shapira 1975); hulls are small, so every edge
/// is tried against every corner.
Rectangle smallestRectangle(const std::vector<cv::Point2f>& points)
{
  std::vector<cv::Point2f> hull;
  cv::convexHull(points, hull);
  std::vector<double> buffer;
  Rectangle best = rectangleAt(0, hull, 0, &buffer);
  for (std::size_t i = 0; hull.size() > 1 && i < hull.size(); ++i)
  {
    const cv::Point2f edge = hull[(i + 1) % hull.size()] - hull[i];
    const Rectangle candidate = rectangleAt(std::atan2(edge.y, edge.x), hull, 0, &buffer);
    if (candidate.area() < best.area())
      best = candidate;
  }
  return best;
}

/// Trimmed extents have no hull to walk along: coarse, then fine search over the angle on a sample of the points.
Rectangle smallestTrimmedRectangle(const std::vector<cv::Point2f>& points, double trim_ratio)
{
  const std::size_t stride = 1 + points.size() / 4000;
  std::vector<cv::Point2f> sample;
  for (std::size_t i = 0; i < points.size(); i += stride)
    sample.push_back(points[i]);
  std::vector<double> buffer;
  const double degree = M_PI / 180;
  Rectangle best = rectangleAt(0, sample, trim_ratio, &buffer);
  const auto search = [&](double from, double to, double step)
  {
    for (double angle = from; angle <= to; angle += step)
    {
      const Rectangle candidate = rectangleAt(angle, sample, trim_ratio, &buffer);
      if (candidate.area() < best.area())
        best = candidate;
    }
  };
  search(degree, 89 * degree, degree);
  search(best.angle_rad - degree, best.angle_rad + degree, 0.05 * degree);
  return rectangleAt(best.angle_rad, points, trim_ratio, &buffer);
}

/// The points without the `share` of them that lies farthest off, in units of the cloud's own spread.
std::vector<Eigen::Vector3f> withoutStrays(const std::vector<Eigen::Vector3f>& points, double share)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : points)
    mean += p.cast<double>();
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d covariance = 1e-12 * Eigen::Matrix3d::Identity();
  for (const Eigen::Vector3f& p : points)
    covariance += (p.cast<double>() - mean) * (p.cast<double>() - mean).transpose() / points.size();
  const Eigen::Matrix3d information = covariance.inverse();
  std::vector<double> distances;
  for (const Eigen::Vector3f& p : points)
    distances.push_back((p.cast<double>() - mean).dot(information * (p.cast<double>() - mean)));
  const double limit = base::quantile(distances, 1 - share);
  std::vector<Eigen::Vector3f> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (distances[i] <= limit)
      kept.push_back(points[i]);
  return kept;
}

void requireUsable(const std::vector<Eigen::Vector3f>& points, double trim_ratio)
{
  if (points.empty())
    throw base::Error(base::StatusCode::BAD_INPUT, "no points to put a box round");
  if (!(trim_ratio >= 0 && trim_ratio < 0.5))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "trim_ratio = " + std::to_string(trim_ratio) + ": must be within [0, 0.5)");
}

}  // namespace

bool OrientedBox::contains(const Eigen::Vector3d& p_frame) const
{
  const Eigen::Array3d p_box = (T_frame_box.inverse(Eigen::Isometry) * p_frame).array();
  return (p_box.abs() <= 0.5 * size_m.array()).all();
}

OrientedBox boxAlong(const Eigen::Vector3d& up, const std::vector<Eigen::Vector3f>& points, double trim_ratio)
{
  requireUsable(points, trim_ratio);
  const Eigen::Vector3d z = up.normalized();
  const Eigen::Vector3d a = z.unitOrthogonal();
  const Eigen::Vector3d b = z.cross(a);
  // Float is too coarse for points far from the origin: the footprint is taken relative to the first of them.
  const Eigen::Vector3d origin = points.front().cast<double>();
  std::vector<cv::Point2f> footprint;
  std::vector<double> heights;
  for (const Eigen::Vector3f& point : points)
  {
    const Eigen::Vector3d p = point.cast<double>() - origin;
    footprint.emplace_back(static_cast<float>(a.dot(p)), static_cast<float>(b.dot(p)));
    heights.push_back(z.dot(p));
  }
  Rectangle rectangle = trim_ratio > 0 ? smallestTrimmedRectangle(footprint, trim_ratio) : smallestRectangle(footprint);
  const Interval height = extent(&heights, trim_ratio);

  const double angle = rectangle.angle_rad;
  Eigen::Vector3d x = std::cos(angle) * a + std::sin(angle) * b;
  Eigen::Vector3d y = z.cross(x);
  const Eigen::Vector3d center =
      origin + rectangle.first.center() * x + rectangle.second.center() * y + height.center() * z;
  if (rectangle.first.length() < rectangle.second.length())
  {
    std::swap(rectangle.first, rectangle.second);
    const Eigen::Vector3d previous_x = x;
    x = y;
    y = -previous_x;
  }
  OrientedBox box;
  box.T_frame_box.linear() << x, y, z;
  box.T_frame_box.translation() = center;
  box.size_m = { rectangle.first.length(), rectangle.second.length(), height.length() };
  return box;
}

OrientedBox smallestBox(const std::vector<Eigen::Vector3f>& points, double trim_ratio)
{
  requireUsable(points, trim_ratio);
  const ConvexHull hull = convexHull(trim_ratio > 0 ? withoutStrays(points, 2 * trim_ratio) : points);
  Eigen::Vector3d best_up = Eigen::Vector3d::UnitZ();
  double best_volume = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& normal : hull.normals)
  {
    const double volume = boxAlong(normal, hull.vertices).size_m.prod();
    // The share makes the first of equal faces win, whatever the rounding.
    if (volume < best_volume * (1 - 1e-6))
    {
      best_volume = volume;
      best_up = normal;
    }
  }
  return boxAlong(best_up, points, trim_ratio);
}

}  // namespace object_modelling::geometry
