#include "object_modelling/evaluation/comparison.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "object_modelling/base/options.h"

namespace object_modelling::evaluation
{
namespace
{
constexpr std::size_t REPORT_EVERY = 5000;

/// Linear between the two values next to it, as numpy.percentile.
double quantile(const std::vector<double>& sorted, double share)
{
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

base::Status unitsStatus(double model_m, double reference_m, double max_ratio)
{
  if (!(model_m > max_ratio * reference_m) && !(reference_m > max_ratio * model_m))
    return {};
  std::ostringstream text;
  text << "the model measures " << model_m << " m and the reference " << reference_m << " m across: one of them is in "
       << "another unit; a file in millimetres is read with --"
       << (reference_m > model_m ? "reference-unit mm" : "model-unit mm");
  return { base::StatusCode::BAD_INPUT, text.str() };
}
}  // namespace

DistanceStatistics statisticsOf(const std::vector<double>& distances_m)
{
  DistanceStatistics statistics;
  if (distances_m.empty())
    return statistics;
  const auto count = static_cast<double>(distances_m.size());
  double squares = 0, variance = 0, outliers = 0;
  for (const double distance_m : distances_m)
  {
    statistics.mean_m += distance_m / count;
    squares += distance_m * distance_m / count;
    outliers += distance_m > OUTLIER_DISTANCE_M;
  }
  for (const double distance_m : distances_m)
    variance += (distance_m - statistics.mean_m) * (distance_m - statistics.mean_m) / count;
  statistics.sigma_m = std::sqrt(variance);
  statistics.rms_m = std::sqrt(squares);
  statistics.outlier_ratio = outliers / count;
  std::vector<double> sorted = distances_m;
  std::sort(sorted.begin(), sorted.end());
  statistics.median_m = quantile(sorted, 0.5);
  statistics.p95_m = quantile(sorted, 0.95);
  statistics.max_m = sorted.back();
  return statistics;
}

std::vector<std::string> ComparisonOptions::violations() const
{
  base::OptionsCheck check("compare");
  check.include(registration.violations());
  check.atLeast("max_size_ratio", max_size_ratio, 1.0);
  check.require("T_start", !T_start || T_start->matrix().allFinite(), "must be finite");
  return check.violations();
}

Comparison compareToReference(const std::vector<Eigen::Vector3d>& points_model, const mesh::ReferenceSurface& surface,
                              const ComparisonOptions& options, base::JobControl& control)
{
  base::checked(options);
  Comparison comparison;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points_model)
    box.extend(point);
  if (points_model.empty() || !box.min().allFinite() || !box.max().allFinite())
  {
    comparison.status = { base::StatusCode::BAD_INPUT, "the model has no points, or some that are not finite" };
    return comparison;
  }
  comparison.model_diagonal_m = box.diagonal().norm();
  comparison.reference_diagonal_m = surface.diagonal_m();
  comparison.status = unitsStatus(comparison.model_diagonal_m, comparison.reference_diagonal_m, options.max_size_ratio);
  if (!comparison.status.ok())
    return comparison;
  comparison.T_reference_model = options.T_start.value_or(Eigen::Isometry3d::Identity());
  if (options.align)
  {
    const RegistrationResult registered =
        registerToSurface(points_model, surface, options.T_start, options.registration, control);
    comparison.status = registered.status;
    if (!registered.status.ok())
      return comparison;
    comparison.T_reference_model = registered.T_reference_model;
    comparison.converged = registered.converged;
  }
  for (std::size_t i = 0; i < points_model.size(); ++i)
  {
    if (i % REPORT_EVERY == 0)
      control.report("measure", i, points_model.size());
    comparison.points_reference.push_back(comparison.T_reference_model * points_model[i]);
    comparison.distances_m.push_back(surface.distance_m(comparison.points_reference.back()));
  }
  control.report("measure", points_model.size(), points_model.size());
  comparison.statistics = statisticsOf(comparison.distances_m);
  return comparison;
}

}  // namespace object_modelling::evaluation
