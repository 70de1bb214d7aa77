#include "object_modelling/registration/matched_surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/point_index.h"
#include "object_modelling/registration/support_contact.h"

namespace object_modelling::registration
{
namespace
{
constexpr double COARSE_REACH_RATIO = 0.25;  // of the part's radius
constexpr double COARSE_CELL_RATIO = 0.04;
constexpr double FINE_REACH_SPACINGS = 3, FINE_CELL_SPACINGS = 0.6;
constexpr double BLUR_SPACINGS = 3, SHARP_SPACINGS = 1.2, SLOPE_SPACINGS = 2;
constexpr std::size_t FEW = 250, MANY = 2500;
constexpr float NEIGHBOR_COSINE = 0.7F;

std::vector<int> evenly(std::size_t all, std::size_t wanted)
{
  std::vector<int> chosen;
  const std::size_t count = std::min(all, wanted);
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(static_cast<int>(i * all / count));
  return chosen;
}

/// Mean colours over a radius.
std::vector<Eigen::Vector3f> smoothed(const PartialModel& model, const geometry::PointIndex& tree, double radius_m,
                                      [[maybe_unused]] int threads)
{
  std::vector<Eigen::Vector3f> result(model.points.size());
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
  for (int i = 0; i < static_cast<int>(model.points.size()); ++i)
  {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float count = 0;
    for (const std::uint32_t near : tree.within(model.points[i], radius_m))
      if (model.normals[near].dot(model.normals[i]) > NEIGHBOR_COSINE)
      {
        sum += model.colors[near];
        count += 1;
      }
    result[i] = count > 0 ? Eigen::Vector3f(sum / count) : model.colors[i];
  }
  return result;
}

/// Median distance of points from the plane through their neighbours: what of two surfaces' distance is noise.
double roughnessOf(const PartialModel& model, const geometry::PointIndex& tree, double radius_m,
                   const std::vector<int>& chosen)
{
  std::vector<double> distances_m;
  for (const int i : chosen)
  {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float count = 0;
    for (const std::uint32_t near : tree.within(model.points[i], radius_m))
      if (model.normals[near].dot(model.normals[i]) > NEIGHBOR_COSINE)
      {
        sum += model.points[near];
        count += 1;
      }
    if (count > 3)
      distances_m.push_back(std::abs(model.normals[i].dot(sum / count - model.points[i])));
  }
  return base::median(&distances_m);
}

/// Least-squares slopes of the colours in the tangent plane (Park, Zhou, Koltun: Colored Point Cloud Registration
/// Revisited, ICCV 2017, section 4).
std::vector<ColorGradient> slopes(const PartialModel& model, const geometry::PointIndex& tree,
                                  const std::vector<Eigen::Vector3f>& colors, double radius_m,
                                  [[maybe_unused]] int threads)
{
  std::vector<ColorGradient> result(model.points.size(), ColorGradient::Zero());
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
  for (int i = 0; i < static_cast<int>(model.points.size()); ++i)
  {
    Eigen::Matrix3f A = 1e-6F * static_cast<float>(radius_m * radius_m) * Eigen::Matrix3f::Identity();
    Eigen::Matrix3f B = Eigen::Matrix3f::Zero();
    const Eigen::Vector3f& n = model.normals[i];
    for (const std::uint32_t near : tree.within(model.points[i], radius_m))
    {
      if (model.normals[near].dot(n) <= NEIGHBOR_COSINE)
        continue;
      Eigen::Vector3f d = model.points[near] - model.points[i];
      d -= n * n.dot(d);
      A += d * d.transpose();
      B += (colors[near] - colors[i]) * d.transpose();
    }
    // Across the surface there is no slope: that direction is held at zero.
    A += A.trace() * n * n.transpose();
    result[i] = B * A.inverse();
  }
  return result;
}
}  // namespace

MatchedSurface::MatchedSurface(const PartialModel& given, int threads)
    : model(given),
      center(given.center()),
      radius_m(static_cast<float>(given.radius_m())),
      coarse(given.points, COARSE_REACH_RATIO * given.radius_m(),
             std::max(COARSE_CELL_RATIO * given.radius_m(), given.spacing_m / 2)),
      fine(given.points, FINE_REACH_SPACINGS * given.spacing_m, FINE_CELL_SPACINGS * given.spacing_m),
      coarse_samples(evenly(given.points.size(), FEW)),
      fine_samples(evenly(given.points.size(), MANY)),
      slope_length_m(BLUR_SPACINGS * given.spacing_m)
{
  const geometry::PointIndex tree(given.points);
  roughness_m = roughnessOf(given, tree, slope_length_m, coarse_samples);
  blurred_colors = smoothed(given, tree, slope_length_m, threads);
  colors = smoothed(given, tree, SHARP_SPACINGS * given.spacing_m, threads);
  blurred_gradients = slopes(given, tree, blurred_colors, slope_length_m, threads);
  gradients = slopes(given, tree, colors, SLOPE_SPACINGS * given.spacing_m, threads);
  if (given.support_plane)
    foot_m = lowestPoint(*this, Eigen::Isometry3f::Identity(), *given.support_plane).height_m;
}

}  // namespace object_modelling::registration
