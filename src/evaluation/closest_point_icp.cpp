#include "closest_point_icp.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::evaluation
{
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, std::size_t count)
{
  if (points.size() <= count)
    return points;
  std::vector<Eigen::Vector3d> kept(count);
  for (std::size_t i = 0; i < count; ++i)
    kept[i] = points[i * points.size() / count];
  return kept;
}

SampleTree::SampleTree(const std::vector<Eigen::Vector3d>& samples) : samples_(samples), index_(samples_)
{
}

std::size_t SampleTree::nearest(const Eigen::Vector3d& query, double* distance_m) const
{
  const auto found = index_.nearest(query);
  *distance_m = std::sqrt(found.squared_distance);
  return found.index;
}

namespace
{
std::size_t keptCount(std::size_t count, double ratio)
{
  return std::min(count, std::max<std::size_t>(6, static_cast<std::size_t>(ratio * static_cast<double>(count))));
}

double rms(const std::vector<double>& values, std::size_t count)
{
  const double sum = std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), 0.0,
                                     [](double total, double value) { return total + value * value; });
  return std::sqrt(sum / static_cast<double>(count));
}
}  // namespace

Placement trimmedIcp(const std::vector<Eigen::Vector3d>& points, const SampleTree& tree, Placement start,
                     double overlap_ratio, int iterations)
{
  const std::size_t kept = keptCount(points.size(), overlap_ratio);
  std::vector<std::size_t> order(points.size()), partners(points.size());
  std::vector<double> distances_m(points.size());
  Eigen::Matrix3Xd moved(3, kept), targets(3, kept);
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
      partners[i] = tree.nearest(start.T_reference_model * points[i], &distances_m[i]);
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept) - 1, order.end(),
                     [&](std::size_t a, std::size_t b)
                     { return distances_m[a] < distances_m[b] || (distances_m[a] == distances_m[b] && a < b); });
    double sum_m2 = 0;
    for (std::size_t k = 0; k < kept; ++k)
    {
      const auto column = static_cast<Eigen::Index>(k);
      moved.col(column) = start.T_reference_model * points[order[k]];
      targets.col(column) = tree.sample(partners[order[k]]);
      sum_m2 += distances_m[order[k]] * distances_m[order[k]];
    }
    start.rms_m = std::sqrt(sum_m2 / static_cast<double>(kept));
    Eigen::Isometry3d step;
    if (!geometry::rigidTransformFromPoints(targets, moved, &step))
      break;
    start.T_reference_model = geometry::normalized(step * start.T_reference_model);
  }
  return start;
}

double fitToSurface(const std::vector<Eigen::Vector3d>& points, const mesh::ReferenceSurface& surface,
                    Eigen::Isometry3d* T_reference_model)
{
  std::vector<Eigen::Vector3d> moved(points.size()), offsets(points.size());
  std::vector<double> distances_m(points.size());
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    moved[i] = *T_reference_model * points[i];
    offsets[i] = moved[i] - surface.closestPoint(moved[i]);
    distances_m[i] = offsets[i].norm();
    center += moved[i] / static_cast<double>(points.size());
  }
  std::vector<double> sorted = distances_m;
  // Tukey's biweight with 95 % efficiency for normal noise, whose sigma is 1.48 medians of the absolute values.
  const double width_m = 4.685 * 1.4826 * base::median(&sorted);
  const double smallest_m = 1e-12 * surface.diagonal_m();

  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  Matrix6d A = Matrix6d::Zero();
  geometry::Vector6d b = geometry::Vector6d::Zero();
  double radius_m = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    radius_m = std::max(radius_m, (moved[i] - center).norm());
    if (!(distances_m[i] > smallest_m) || distances_m[i] >= width_m)
      continue;
    const double share = distances_m[i] / width_m;
    const double weight = (1 - share * share) * (1 - share * share);
    const Eigen::Vector3d normal = offsets[i] / distances_m[i];
    geometry::Vector6d row;
    row << normal, (moved[i] - center).cross(normal);
    A += weight * row * row.transpose();
    b -= weight * distances_m[i] * row;
  }
  // Rotations measured by the radius, so that one damping serves all six.
  geometry::Vector6d scale = geometry::Vector6d::Ones();
  scale.tail<3>() /= std::max(radius_m, smallest_m);
  A = scale.asDiagonal() * A * scale.asDiagonal();
  A.diagonal().array() += 1e-9 * A.trace() + 1e-30;
  geometry::Vector6d step = geometry::solveSymmetric(A, scale.asDiagonal() * b);
  const double size_m = step.norm();
  step = scale.asDiagonal() * step;
  const Eigen::Isometry3d about_center =
      Eigen::Translation3d(center) * geometry::isometryFromVector(step) * Eigen::Translation3d(-center);
  *T_reference_model = geometry::normalized(about_center * *T_reference_model);
  return size_m;
}

double trimmedRms_m(const std::vector<Eigen::Vector3d>& points, const mesh::ReferenceSurface& surface,
                    const Eigen::Isometry3d& T_reference_model, double overlap_ratio)
{
  std::vector<double> distances_m;
  distances_m.reserve(points.size());
  for (const Eigen::Vector3d& point : points)
    distances_m.push_back(surface.distance_m(T_reference_model * point));
  std::sort(distances_m.begin(), distances_m.end());
  return rms(distances_m, keptCount(points.size(), overlap_ratio));
}

}  // namespace object_modelling::evaluation
