#include "object_modelling/evaluation/registration.h"

#include <algorithm>
#include <cmath>

#include "closest_point_icp.h"
#include "object_modelling/base/options.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::evaluation
{
namespace
{
constexpr std::size_t MIN_POINTS = 20, MIN_TRIANGLES = 4, SECOND_POINT_COUNT = 1500, MAX_CANDIDATES = 12,
                      MAX_FINALISTS = 4;
constexpr int SEARCH_ITERATIONS = 12, SECOND_ITERATIONS = 15, THIRD_ITERATIONS = 10;
constexpr double CANDIDATE_RATIO = 1.8, FINALIST_RATIO = 1.3;  // against the best fit
constexpr double SAME_ANGLE_RAD = 4 * M_PI / 180, SAME_PLACE_RATIO = 0.02;
constexpr double CONVERGED_RATIO = 1e-6;  // step against the size of the reference

/// Rotations spread evenly over all (Alexa, Super-Fibonacci Spirals, CVPR 2022).
Eigen::Quaterniond evenRotation(int index, int count)
{
  static constexpr double PSI = 1.533751168755204288118041;
  const double s = index + 0.5;
  const double r = std::sqrt(s / count), R = std::sqrt(1 - s / count);
  const double alpha = 2 * M_PI * s / M_SQRT2, beta = 2 * M_PI * s / PSI;
  return { R * std::cos(beta), r * std::sin(alpha), r * std::cos(alpha), R * std::sin(beta) };
}

Eigen::Vector3d meanOf(const std::vector<Eigen::Vector3d>& points)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
    mean += point / static_cast<double>(points.size());
  return mean;
}

bool better(const Placement& a, const Placement& b)
{
  return a.rms_m < b.rms_m;
}

/// The best placements of the search that differ from each other.
std::vector<Placement> differing(std::vector<Placement> sorted, const Eigen::Vector3d& middle_model, double size_m)
{
  std::vector<Placement> kept;
  for (const Placement& placement : sorted)
  {
    if (placement.rms_m > CANDIDATE_RATIO * sorted.front().rms_m + 0.005 * size_m || kept.size() == MAX_CANDIDATES)
      break;
    const bool known = std::any_of(kept.begin(), kept.end(),
                                   [&](const Placement& other)
                                   {
                                     const Eigen::Isometry3d& A = placement.T_reference_model;
                                     const Eigen::Isometry3d& B = other.T_reference_model;
                                     return geometry::rotationAngle_rad(A.inverse() * B) < SAME_ANGLE_RAD &&
                                            (A * middle_model - B * middle_model).norm() < SAME_PLACE_RATIO * size_m;
                                   });
    if (!known)
      kept.push_back(placement);
  }
  return kept;
}

Eigen::Isometry3d searchPlacement(const std::vector<Eigen::Vector3d>& points_model,
                                  const mesh::ReferenceSurface& surface, const RegistrationOptions& options,
                                  base::JobControl& control)
{
  const std::vector<Eigen::Vector3d> few = thinned(points_model, options.search_point_count);
  const std::vector<Eigen::Vector3d> more = thinned(points_model, SECOND_POINT_COUNT);
  const Eigen::Vector3d middle_model = meanOf(points_model), middle_reference = meanOf(surface.samples());
  const SampleTree coarse(thinned(surface.samples(), 4000));
  std::vector<Placement> placements(options.start_count);
  control.report("search", 0, 3);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < options.start_count; ++i)
  {
    const Eigen::Quaterniond R = evenRotation(i, options.start_count);
    const Placement start{ geometry::isometryFrom(R, middle_reference - R * middle_model), 0 };
    placements[i] = trimmedIcp(few, coarse, start, options.overlap_ratio, SEARCH_ITERATIONS);
  }
  std::stable_sort(placements.begin(), placements.end(), better);
  placements = differing(std::move(placements), middle_model, surface.diagonal_m());

  control.report("search", 1, 3);
  const SampleTree dense(surface.samples());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < placements.size(); ++i)
    placements[i] = trimmedIcp(more, dense, placements[i], options.overlap_ratio, SECOND_ITERATIONS);
  std::stable_sort(placements.begin(), placements.end(), better);

  control.report("search", 2, 3);
  const double limit_m = FINALIST_RATIO * placements.front().rms_m;
  while (placements.size() > MAX_FINALISTS || placements.back().rms_m > limit_m)
    placements.pop_back();
  for (Placement& placement : placements)
  {
    for (int iteration = 0; iteration < THIRD_ITERATIONS; ++iteration)
      fitToSurface(more, surface, &placement.T_reference_model);
    placement.rms_m = trimmedRms_m(more, surface, placement.T_reference_model, options.overlap_ratio);
  }
  control.report("search", 3, 3);
  return std::min_element(placements.begin(), placements.end(), better)->T_reference_model;
}
}  // namespace

std::vector<std::string> RegistrationOptions::violations() const
{
  base::OptionsCheck check("registration");
  check.inRange("start_count", start_count, 1, 100000);
  check.inRange("overlap_ratio", overlap_ratio, 0.1, 1.0);
  check.atLeast("search_point_count", search_point_count, 20);
  check.atLeast("fit_point_count", fit_point_count, 20);
  check.atLeast("max_iterations", max_iterations, 1);
  return check.violations();
}

RegistrationResult registerToSurface(const std::vector<Eigen::Vector3d>& points_model,
                                     const mesh::ReferenceSurface& surface,
                                     const std::optional<Eigen::Isometry3d>& T_start,
                                     const RegistrationOptions& options, base::JobControl& control)
{
  base::checked(options);
  RegistrationResult result;
  if (points_model.size() < MIN_POINTS || surface.triangleCount() < MIN_TRIANGLES)
  {
    result.status = { base::StatusCode::NO_RESULT,
                      "a model of " + std::to_string(points_model.size()) + " points and a reference of " +
                          std::to_string(surface.triangleCount()) +
                          " triangles do not fix a pose: at least 20 points and 4 triangles are needed; bring both "
                          "into one frame and measure without alignment" };
    return result;
  }
  result.T_reference_model = T_start ? *T_start : searchPlacement(points_model, surface, options, control);
  const std::vector<Eigen::Vector3d> points = thinned(points_model, options.fit_point_count);
  for (; result.iterations < options.max_iterations && !result.converged; ++result.iterations)
  {
    control.report("fit", result.iterations, options.max_iterations);
    const double step_m = fitToSurface(points, surface, &result.T_reference_model);
    result.converged = step_m < CONVERGED_RATIO * surface.diagonal_m();
  }
  control.report("fit", options.max_iterations, options.max_iterations);
  return result;
}

}  // namespace object_modelling::evaluation
