#include "bundle_solver.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include <ceres/ceres.h>

#include "cost_functions.h"
#include "object_modelling/geometry/transform.h"
#include "sensor_blocks.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
constexpr double SURFACE_LOSS_FACTOR = 2;  // six residuals at once are larger than one

/// Reports progress, and stops the solver when the callback or a cancellation throws; the exception waits until the
/// solver has returned.
class ProgressCallback : public ceres::IterationCallback
{
public:
  ProgressCallback(base::JobControl* control, int max_iterations) : control_(control), max_iterations_(max_iterations)
  {
  }
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override
  {
    try
    {
      control_->report("bundle adjustment", static_cast<std::size_t>(summary.iteration),
                       static_cast<std::size_t>(max_iterations_));
    }
    catch (...)
    {
      exception_ = std::current_exception();
      return ceres::SOLVER_ABORT;
    }
    return ceres::SOLVER_CONTINUE;
  }
  void rethrow() const
  {
    if (exception_)
      std::rethrow_exception(exception_);
  }

private:
  base::JobControl* control_;
  int max_iterations_;
  std::exception_ptr exception_;
};

ceres::Solver::Options ceresOptions(const BundleSolverOptions& options)
{
  ceres::Solver::Options result;
  // Nearly all time goes into residuals and elimination; on 60 keyframes SPARSE, DENSE and ITERATIVE_SCHUR are within a
  // quarter of each other, and this one stays usable with hundreds.
  result.linear_solver_type = ceres::SPARSE_SCHUR;
  result.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  result.max_num_iterations = options.max_iterations;
  result.num_threads = options.threads;
  result.function_tolerance = options.min_improvement_ratio;
  result.logging_type = ceres::SILENT;
  result.minimizer_progress_to_stdout = false;
  return result;
}

/// What the solver changes, and which keyframes have a residual.
struct Blocks
{
  Blocks(const std::vector<rgbd::Keyframe>& keyframes, const BundleState& state)
      : motions(keyframes.size(), geometry::Vector6d::Zero()),
        landmarks(state.map.landmarks),
        sensor(state),
        seen(keyframes.size(), false)
  {
    cameras.reserve(keyframes.size());
    for (std::size_t k = 0; k < keyframes.size(); ++k)
      cameras.emplace_back(keyframes[k].frame.camera, state.T_session_camera[k]);
  }

  std::vector<LinearizedCamera> cameras;
  std::vector<geometry::Vector6d> motions;
  std::vector<Eigen::Vector3d> landmarks;
  SensorBlocks sensor;
  std::vector<bool> seen;
};

void addSights(const std::vector<rgbd::Keyframe>& keyframes, const BundleSolverOptions& options,
               const std::vector<Sight>& sights, ceres::LossFunction* loss, Blocks* blocks, ceres::Problem* problem,
               ceres::ParameterBlockOrdering* ordering)
{
  for (const Sight& sight : sights)
  {
    double* motion = blocks->motions[sight.keyframe].data();
    double* landmark = blocks->landmarks[sight.landmark].data();
    const LinearizedCamera* camera = &blocks->cameras[sight.keyframe];
    problem->AddResidualBlock(new ReprojectionCost(camera, sight.pixel, sight.sigma_px), loss, motion, landmark,
                              blocks->sensor.color_offset_px.data(), blocks->sensor.intrinsics.data());
    if (sight.depth_m > 0)
    {
      const double sigma_m = keyframes[sight.keyframe].frame.noise_model.axialSigma_m(sight.depth_m, 0);
      blocks->sensor.addDepthCost(std::make_unique<DepthCost>(camera, sight.depth_m, sight.depth_slope_m_px, sigma_m),
                                  sight.pixel, keyframes[sight.keyframe].frame.camera, options, loss, motion, landmark,
                                  problem);
    }
    ordering->AddElementToGroup(landmark, 0);
    ordering->AddElementToGroup(motion, 1);
    blocks->seen[sight.keyframe] = true;
  }
}

void addSurfaces(const std::vector<SurfaceLink>& links, ceres::LossFunction* loss, Blocks* blocks,
                 ceres::Problem* problem, ceres::ParameterBlockOrdering* ordering)
{
  for (const SurfaceLink& link : links)
  {
    problem->AddResidualBlock(surfaceCost(blocks->cameras[link.a], blocks->cameras[link.b], link), loss,
                              blocks->motions[link.a].data(), blocks->motions[link.b].data(),
                              blocks->sensor.color_offset_px.data());
    for (const int k : { link.a, link.b })
    {
      ordering->AddElementToGroup(blocks->motions[k].data(), 1);
      blocks->seen[k] = true;
    }
  }
}

}  // namespace

BundleSolverSummary solveBundle(const std::vector<rgbd::Keyframe>& keyframes, int fixed_keyframe,
                                const BundleSolverOptions& options, base::JobControl& control, BundleState* state)
{
  Blocks blocks(keyframes, *state);
  ceres::CauchyLoss loss(options.loss_width_sigmas), surface_loss(SURFACE_LOSS_FACTOR * options.loss_width_sigmas);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  ceres::Solver::Options solver_options = ceresOptions(options);
  solver_options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  addSights(keyframes, options, state->map.sights, &loss, &blocks, &problem,
            solver_options.linear_solver_ordering.get());
  addSurfaces(state->surface_links, &surface_loss, &blocks, &problem, solver_options.linear_solver_ordering.get());
  if (fixed_keyframe >= 0 && blocks.seen[fixed_keyframe])
    problem.SetParameterBlockConstant(blocks.motions[fixed_keyframe].data());

  blocks.sensor.finish(options, &problem, solver_options.linear_solver_ordering.get());

  ProgressCallback callback(&control, options.max_iterations);
  solver_options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options, &problem, &summary);
  callback.rethrow();

  BundleSolverSummary result;
  result.usable = summary.IsSolutionUsable();
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.iterations = static_cast<int>(summary.iterations.size());
  if (!result.usable)
    return result;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
  {
    if (blocks.seen[k] && static_cast<int>(k) != fixed_keyframe)
    {
      state->T_session_camera[k] = geometry::normalized(
          (geometry::isometryFromVector(blocks.motions[k]) * blocks.cameras[k].T_camera_session).inverse());
    }
  }
  state->map.landmarks = std::move(blocks.landmarks);
  blocks.sensor.store(options, &problem, state);
  return result;
}

SightError sightError(const Sight& sight, const geometry::PinholeCamera& camera, const BundleState& state)
{
  const Eigen::Vector3d p_camera =
      state.T_session_camera[sight.keyframe].inverse() * state.map.landmarks[sight.landmark];
  SightError error;
  const Eigen::Vector2d principal_px(camera.cx, camera.cy);
  const Eigen::Vector2d pixel = principal_px + state.sensor.principal_shift_px + state.color_offset_px +
                                state.sensor.focal_ratio.cwiseProduct(camera.project(p_camera) - principal_px);
  error.pixel_px = p_camera.z() > 1e-3 ? (pixel - sight.pixel).norm() : std::numeric_limits<double>::infinity();
  const double distortion = rgbd::DistortionGrid::ratioAt(state.sensor.depth_distortion_ratio, sight.pixel.x(),
                                                          sight.pixel.y(), camera.width, camera.height);
  const double measured_m = (1 - distortion) * sight.depth_m - sight.depth_slope_m_px.dot(state.color_offset_px);
  error.depth_m = p_camera.z() - state.sensor.depth_ratio * measured_m - state.sensor.depth_offset_m;
  return error;
}

double robustCost(const std::vector<rgbd::Keyframe>& keyframes, double loss_width_sigmas, const BundleState& state)
{
  const double width_squared = loss_width_sigmas * loss_width_sigmas;
  const auto loss = [&](double sigmas) { return 0.5 * width_squared * std::log1p(sigmas * sigmas / width_squared); };
  double cost = 0;
  for (const Sight& sight : state.map.sights)
  {
    const rgbd::Frame& frame = keyframes[sight.keyframe].frame;
    const SightError error = sightError(sight, frame.camera, state);
    cost += loss(std::min(error.pixel_px / sight.sigma_px, 1e3));
    if (sight.depth_m > 0)
      cost += loss(error.depth_m / frame.noise_model.axialSigma_m(sight.depth_m, 0));
  }
  return cost;
}

}  // namespace object_modelling::bundle_adjustment
