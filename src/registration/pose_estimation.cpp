#include "object_modelling/registration/pose_estimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Dense>

#include "object_modelling/base/ransac.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::registration
{
namespace
{
constexpr double POSE_CONVERGED_STEP = 1e-7;  // m and rad
constexpr double MIN_DEPTH_M = 0.05;

/// Both the point and the measurement come from a depth image.
double depthSigma_m(double z_m, const PoseEstimationOptions& options)
{
  return std::sqrt(2.0) * options.noise_model.axialSigma_m(z_m, 0);
}

/// Squared reprojection error; infinite behind the camera.
double squaredError_px(const Correspondence& correspondence, const Eigen::Vector3d& p_camera,
                       const geometry::PinholeCamera& camera)
{
  if (p_camera.z() < MIN_DEPTH_M)
    return std::numeric_limits<double>::infinity();
  return (camera.project(p_camera) - correspondence.pixel).squaredNorm();
}

/// Whether there is a measured depth that fits the predicted one. One that does not (another surface at an edge, colour
/// and depth exposed at different times) is no evidence against the landmark's pixel.
bool depthCounts(const Correspondence& correspondence, double z_m, const PoseEstimationOptions& options)
{
  return std::abs(correspondence.depth_m - z_m) <= options.depth_gate_sigmas * depthSigma_m(z_m, options);
}

/// Hypotheses are ranked by both: landmarks whose measured depth contradicts count half.
double score(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
             const Eigen::Isometry3d& T_camera_world, const PoseEstimationOptions& options)
{
  const double squared_gate = options.max_reprojection_error_px * options.max_reprojection_error_px;
  double sum = 0;
  for (const Correspondence& correspondence : correspondences)
  {
    const Eigen::Vector3d p = T_camera_world * correspondence.p_world;
    if (squaredError_px(correspondence, p, camera) <= squared_gate)
      sum += std::isnan(correspondence.depth_m) || depthCounts(correspondence, p.z(), options) ? 1.0 : 0.5;
  }
  return sum;
}

/// Standard deviation of one coordinate of the reprojection errors, from their median; those beyond twice the gate are
/// left out.
double robustSigma_px(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                      const Eigen::Isometry3d& T_camera_world, const PoseEstimationOptions& options)
{
  std::vector<double> errors_px;
  for (const Correspondence& correspondence : correspondences)
  {
    const double squared = squaredError_px(correspondence, T_camera_world * correspondence.p_world, camera);
    if (squared <= 4 * options.max_reprojection_error_px * options.max_reprojection_error_px)
      errors_px.push_back(std::sqrt(squared));
  }
  if (errors_px.empty())
    return options.pixel_sigma_px;
  // The median of a two-dimensional error is 1.18 standard deviations of one coordinate.
  return base::median(&errors_px) / 1.18;
}

geometry::NormalEquations linearize(const std::vector<Correspondence>& correspondences,
                                    const geometry::PinholeCamera& camera, const Eigen::Isometry3d& T_camera_world,
                                    const PoseEstimationOptions& options)
{
  geometry::NormalEquations equations;
  const auto add = [&equations](const Eigen::Matrix<double, 1, 6>& jacobian, double residual, double sigma)
  { equations.add(jacobian, residual, geometry::huberWeight(residual / sigma) / (sigma * sigma)); };
  const double squared_gate = options.max_reprojection_error_px * options.max_reprojection_error_px;
  for (const Correspondence& correspondence : correspondences)
  {
    const Eigen::Vector3d p = T_camera_world * correspondence.p_world;
    if (squaredError_px(correspondence, p, camera) > squared_gate)
      continue;
    const double inverse_z = 1 / p.z();
    Eigen::Matrix<double, 3, 6> dp;
    dp << Eigen::Matrix3d::Identity(),
        (Eigen::Matrix3d() << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0).finished();
    const Eigen::Vector2d residual = camera.project(p) - correspondence.pixel;
    const Eigen::Matrix<double, 1, 6> du = camera.fx * inverse_z * (dp.row(0) - p.x() * inverse_z * dp.row(2));
    const Eigen::Matrix<double, 1, 6> dv = camera.fy * inverse_z * (dp.row(1) - p.y() * inverse_z * dp.row(2));
    add(du, residual.x(), options.pixel_sigma_px);
    add(dv, residual.y(), options.pixel_sigma_px);
    if (depthCounts(correspondence, p.z(), options))
      add(dp.row(2), p.z() - correspondence.depth_m, depthSigma_m(p.z(), options));
  }
  return equations;
}

/// Least squares with a fixed gate.
PoseEstimate solve(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                   const Eigen::Isometry3d& T_world_camera_start, const PoseEstimationOptions& options,
                   const QuadraticTerm* term)
{
  PoseEstimate estimate;
  Eigen::Isometry3d T_camera_world = T_world_camera_start.inverse();
  const auto equations_at = [&](const Eigen::Isometry3d& T)
  {
    geometry::NormalEquations equations = linearize(correspondences, camera, T, options);
    if (term)
      equations += term->at(T);
    return equations;
  };
  for (int iteration = 0; iteration < options.max_iterations; ++iteration)
  {
    const geometry::NormalEquations equations = equations_at(T_camera_world);
    const std::optional<geometry::Vector6d> step = geometry::solveWellPosed(equations.A, equations.b);
    if (!step)
      return estimate;
    T_camera_world = geometry::normalized(geometry::isometryFromVector(*step) * T_camera_world);
    if (step->cwiseAbs().maxCoeff() < POSE_CONVERGED_STEP)
      break;
  }
  double squared_sum = 0;
  const double squared_gate = options.max_reprojection_error_px * options.max_reprojection_error_px;
  estimate.inliers.assign(correspondences.size(), 0);
  for (std::size_t i = 0; i < correspondences.size(); ++i)
  {
    const double squared = squaredError_px(correspondences[i], T_camera_world * correspondences[i].p_world, camera);
    if (squared > squared_gate)
      continue;
    estimate.inliers[i] = 1;
    ++estimate.inlier_count;
    squared_sum += squared;
  }
  if (estimate.inlier_count < 4 && !term)
    return estimate;
  estimate.valid = true;
  estimate.T_world_camera = T_camera_world.inverse();
  estimate.reprojection_rmse_px = std::sqrt(squared_sum / std::max(1, estimate.inlier_count));
  estimate.covariance = geometry::inverseOf(equations_at(T_camera_world).A);
  return estimate;
}

}  // namespace

geometry::NormalEquations QuadraticTerm::at(const Eigen::Isometry3d& T) const
{
  geometry::NormalEquations moved = equations;
  moved.b -= equations.A * geometry::vectorFromIsometry(T * T_camera_world.inverse());
  return moved;
}

PoseEstimate refinePose(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera_start, const PoseEstimationOptions& options,
                        const QuadraticTerm* term)
{
  PoseEstimationOptions gated = options;
  gated.max_reprojection_error_px = 2 * options.max_reprojection_error_px;
  gated.max_iterations = 3;
  PoseEstimate rough = solve(correspondences, camera, T_world_camera_start, gated, term);
  if (!rough.valid)
    return rough;
  const double sigma_px = robustSigma_px(correspondences, camera, rough.T_world_camera.inverse(), options);
  gated.pixel_sigma_px = std::max(options.min_pixel_sigma_px, sigma_px);
  // Three standard deviations, between once and twice the option: motion blur and a rolling shutter widen the errors of
  // a whole frame.
  gated.max_reprojection_error_px = std::clamp(3 * std::sqrt(2.0) * sigma_px, options.max_reprojection_error_px,
                                               2 * options.max_reprojection_error_px);
  gated.max_iterations = options.max_iterations;
  PoseEstimate estimate = solve(correspondences, camera, rough.T_world_camera, gated, term);
  const Eigen::Isometry3d T_camera_world = estimate.T_world_camera.inverse();
  const double squared_gate = options.max_reprojection_error_px * options.max_reprojection_error_px;
  for (std::size_t i = 0; i < estimate.inliers.size(); ++i)
    estimate.close_count +=
        estimate.inliers[i] &&
        squaredError_px(correspondences[i], T_camera_world * correspondences[i].p_world, camera) <= squared_gate;
  return estimate;
}

PoseEstimate estimatePose(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                          const Eigen::Isometry3d& T_world_camera_prior, std::uint64_t seed,
                          const PoseEstimationOptions& options)
{
  const std::size_t count = correspondences.size();
  if (count < 4)
    return {};
  std::vector<std::size_t> with_depth;
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isnan(correspondences[i].depth_m))
      with_depth.push_back(i);

  const auto solve_triple = [&](const std::array<int, 3>& triple) -> std::optional<Eigen::Isometry3d>
  {
    Eigen::Matrix3Xd p_world(3, 3), p_camera(3, 3);
    for (int k = 0; k < 3; ++k)
    {
      const Correspondence& drawn = correspondences[with_depth[triple[k]]];
      p_world.col(k) = drawn.p_world;
      p_camera.col(k) = camera.unproject(drawn.pixel.x(), drawn.pixel.y(), drawn.depth_m);
    }
    Eigen::Isometry3d T_world_camera;
    if (!geometry::rigidTransformFromPoints(p_world, p_camera, &T_world_camera))
      return std::nullopt;
    return T_world_camera;
  };
  const auto inlier_ratio = [&](const Eigen::Isometry3d& T_world_camera)
  { return score(correspondences, camera, T_world_camera.inverse(), options) / static_cast<double>(count); };
  base::RansacOptions ransac_options;
  ransac_options.max_samples = options.max_hypotheses;
  ransac_options.confidence_ratio = options.confidence_ratio;
  ransac_options.seed = seed;
  const base::Hypothesis<Eigen::Isometry3d> prior{ T_world_camera_prior, inlier_ratio(T_world_camera_prior) };
  const auto best =
      base::ransac<3, Eigen::Isometry3d>(with_depth.size(), ransac_options, solve_triple, inlier_ratio, prior);
  return refinePose(correspondences, camera, best->model, options);
}

}  // namespace object_modelling::registration
