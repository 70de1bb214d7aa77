#include "object_modelling/registration/dense_alignment.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "dense_residuals.h"
#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::registration
{
namespace
{
constexpr double CONVERGED_STEP_SIGMAS = 0.5;   // of the estimate; the least squares with features goes on from there
constexpr double FINEST_CONVERGED_STEP = 1e-4;  // m and rad at the finest level, however well it is known
constexpr std::size_t MIN_RESIDUALS = 60;
// Errors of the directions along which residuals are measured. They let a surface slide along itself, and yet count as
// knowledge of where it is.
constexpr float GRADIENT_NOISE = 0.5F;        // grey levels per pixel: sensor and compression
constexpr float GRADIENT_NOISE_RATIO = 0.1F;  // of a gradient: staircases of edges, interpolation
constexpr float NORMAL_NOISE_PX = 8;          // a normal is as unsure as depth is, over this many pixels
constexpr int NOISE_SAMPLES = 8;              // one of so many residuals is used to estimate their noise
constexpr double NOISE_FACTOR = 2;            // information beyond that many times the noise's counts

/// Cauchy's weight: outliers (occlusion, highlights) have little weight, but enough to correct a poor start.
float cauchyWeight(float residual_scales)
{
  constexpr float WIDTH = 2.385F;  // 95 % efficient for normal errors
  const float ratio = residual_scales / WIDTH;
  return 1 / (1 + ratio * ratio);
}

/// Sums of one kind of residual, whose Jacobian is [a; q x a] for a motion on the left of the camera's transform.
class Sums
{
public:
  void add(const Eigen::Vector3f& q, const Eigen::Vector3f& a, float residual, float weight)
  {
    const Eigen::Vector3f moment = q.cross(a);
    // Six entries, the residual, and nothing: two registers of four.
    Row row;
    row << a.x(), a.y(), a.z(), moment.x(), moment.y(), moment.z(), residual, 0;
    const Row weighted = weight * row;
    for (int column = 0; column < 6; ++column)
      products_.col(column) += row(column) * weighted;
  }
  void addTo(geometry::NormalEquations* equations, double factor) const
  {
    equations->A += factor * products_.topRows<6>().cast<double>();
    equations->b -= factor * products_.row(6).transpose().cast<double>();
  }

private:
  using Row = Eigen::Matrix<float, 8, 1>;
  Eigen::Matrix<float, 8, 6> products_ = Eigen::Matrix<float, 8, 6>::Zero();
};

float depthWeight(const DenseResidual& s, const DenseResiduals& residuals)
{
  const float per_sigma = 1 / (residuals.depth_scale * s.depth_sigma);
  return cauchyWeight(s.depth_residual * per_sigma) * per_sigma * per_sigma;
}

float intensityWeight(const DenseResidual& s, const DenseResiduals& residuals)
{
  const float per_scale = 1 / residuals.intensity_scale;
  return cauchyWeight(s.intensity_residual * per_scale) * per_scale * per_scale;
}

/// Derivative by the point of what the image shows there, for a gradient in pixels.
Eigen::Vector3f imageDirection(float gradient_x, float gradient_y, const DenseResidual& s, const DenseLevel& level)
{
  const float inverse_z = 1 / s.q.z();
  const float x = gradient_x * level.fx * inverse_z;
  const float y = gradient_y * level.fy * inverse_z;
  return { x, y, -(x * s.q.x() + y * s.q.y()) * inverse_z };
}

geometry::NormalEquations equationsOf(const DenseResiduals& residuals, const DenseLevel& level,
                                      const DenseAlignmentOptions& options)
{
  Sums depth, intensity;
  for (const DenseResidual& s : residuals.all)
  {
    if (s.has_depth)
      depth.add(s.q, s.normal, s.depth_residual, depthWeight(s, residuals));
    if (s.textured)
      intensity.add(s.q, imageDirection(s.gradient_x, s.gradient_y, s, level), s.intensity_residual,
                    intensityWeight(s, residuals));
  }
  geometry::NormalEquations equations;
  depth.addTo(&equations, residuals.pixels_per_point / options.correlated_depths);
  intensity.addTo(&equations, residuals.edges_per_point / options.correlated_intensities);
  return equations;
}

/// What the errors of gradients and normals alone bring into the information.
geometry::Matrix6d noiseOf(const DenseResiduals& residuals, const DenseLevel& level,
                           const DenseAlignmentOptions& options)
{
  Sums depth, intensity;
  for (std::size_t i = 0; i < residuals.all.size(); i += NOISE_SAMPLES)
  {
    const DenseResidual& s = residuals.all[i];
    if (s.has_depth)
    {
      const float slope = averagedDepthSigma_m(level.noise_model, s.q.z()) * level.fx / (NORMAL_NOISE_PX * s.q.z());
      const float weight = slope * slope * depthWeight(s, residuals);
      const Eigen::Vector3f tangent = s.normal.unitOrthogonal();
      depth.add(s.q, tangent, 0, weight);
      depth.add(s.q, s.normal.cross(tangent), 0, weight);
    }
    if (s.textured)
    {
      const float weight =
          intensityWeight(s, residuals) *
          (GRADIENT_NOISE * GRADIENT_NOISE +
           GRADIENT_NOISE_RATIO * GRADIENT_NOISE_RATIO * (s.gradient_x * s.gradient_x + s.gradient_y * s.gradient_y));
      intensity.add(s.q, imageDirection(1, 0, s, level), 0, weight);
      intensity.add(s.q, imageDirection(0, 1, s, level), 0, weight);
    }
  }
  geometry::NormalEquations noise;
  depth.addTo(&noise, NOISE_SAMPLES * residuals.pixels_per_point / options.correlated_depths);
  intensity.addTo(&noise, NOISE_SAMPLES * residuals.edges_per_point / options.correlated_intensities);
  return noise.A;
}

/// Removes the information due to noise: A v = lambda N v gives directions v with lambda, the ratio of their
/// information to the noise's; each keeps the excess. The minimum does not move.
void removeNoise(const geometry::Matrix6d& noise, geometry::NormalEquations* equations)
{
  const auto information = geometry::informationOverNoise(equations->A, noise);
  if (!information)
    return;
  // With V^T N V = 1: A = U diag(lambda) U^T and b = U (V^T b), where U = N V.
  const geometry::Matrix6d& V = information->V;
  const geometry::Matrix6d U = information->N * V;
  geometry::Vector6d kept = (information->ratios.array() - NOISE_FACTOR).max(0.0);
  const geometry::Vector6d b = V.transpose() * equations->b;
  equations->A = U * kept.asDiagonal() * U.transpose();
  kept.array() /= information->ratios.array().max(NOISE_FACTOR);
  equations->b = U * kept.cwiseProduct(b);
}

/// One evaluation; the noise is left in.
DenseTerm evaluate(const DensePoints& points, const DenseLevel& level, const Eigen::Isometry3d& T_camera_reference,
                   const DenseAlignmentOptions& options, DenseResiduals* residuals)
{
  observe(points, level, T_camera_reference, residuals);
  DenseTerm term;
  term.in_view = residuals->in_view;
  term.overlap =
      points.all.empty() ? 0 : static_cast<double>(residuals->in_view) / static_cast<double>(points.all.size());
  term.depth_agreement =
      residuals->with_depth > 0 ? static_cast<double>(residuals->agreeing) / residuals->with_depth : 0;
  if (residuals->all.size() < MIN_RESIDUALS)
    return term;
  term.correlation = residuals->correlation;
  term.intensity_scale = residuals->intensity_scale;
  term.equations = equationsOf(*residuals, level, options);
  return term;
}
}  // namespace

DenseTerm evaluateDense(const DensePoints& points, const DenseLevel& level, const Eigen::Isometry3d& T_camera_world,
                        const Eigen::Isometry3d& T_world_reference, const DenseAlignmentOptions& options)
{
  DenseResiduals residuals;
  DenseTerm term = evaluate(points, level, T_camera_world * T_world_reference, options, &residuals);
  if (!term.equations.A.isZero())
    removeNoise(noiseOf(residuals, level, options), &term.equations);
  return term;
}

DenseAlignment alignDense(const DenseReference& reference, const Eigen::Isometry3d& T_world_reference,
                          const DensePyramid& frame, const Eigen::Isometry3d& T_world_camera_start,
                          const geometry::Matrix6d& prior, const DenseAlignmentOptions& options)
{
  DenseAlignment alignment;
  const Eigen::Isometry3d T_camera_world_start = T_world_camera_start.inverse();
  Eigen::Isometry3d T_camera_world = T_camera_world_start;
  DenseResiduals residuals;
  const auto without_noise = [&](int level)
  {
    if (!alignment.term.equations.A.isZero())
      removeNoise(noiseOf(residuals, frame.levels()[level], options), &alignment.term.equations);
    return alignment;
  };
  const int coarsest = std::min({ static_cast<int>(reference.levels().size()) - 1,
                                  static_cast<int>(frame.levels().size()) - 1, options.coarsest_level });
  for (int i = coarsest; i >= options.finest_level; --i)
  {
    const DenseLevel& level = frame.levels()[i];
    bool small_step = false;
    for (int iteration = 0; iteration < options.max_iterations && !small_step; ++iteration)
    {
      alignment.term = evaluate(reference.levels()[i], level, T_camera_world * T_world_reference, options, &residuals);
      alignment.T_world_camera = T_camera_world.inverse();
      geometry::NormalEquations equations = alignment.term.equations;
      if (equations.A.isZero())
        return alignment;
      const geometry::Vector6d off_start =
          geometry::vectorFromIsometry(T_camera_world * T_camera_world_start.inverse());
      equations.A += prior;
      equations.b -= prior * off_start;
      const geometry::Vector6d step = geometry::solveSymmetric(equations.A, equations.b);
      if (!step.allFinite())
        return without_noise(i);
      const double coarse = level.step / static_cast<double>(frame.levels()[0].step);
      small_step = step.cwiseAbs().maxCoeff() < FINEST_CONVERGED_STEP * coarse * coarse ||
                   step.dot(equations.A * step) < CONVERGED_STEP_SIGMAS * CONVERGED_STEP_SIGMAS;
      // The term stands for the pose at which it was evaluated, so the last step is left to whoever uses the term.
      if (!small_step || i > options.finest_level)
        T_camera_world = geometry::normalized(geometry::isometryFromVector(step) * T_camera_world);
    }
    alignment.converged = small_step;
  }
  return without_noise(options.finest_level);
}

}  // namespace object_modelling::registration
