#include "icp_report.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::multi_view_icp
{
namespace
{
// Neighbouring points err alike (interpolation, calibration, smooth distortion of depth): so many weigh as much as one.
constexpr double CORRELATED_POINTS = 30;
constexpr double UNKNOWN_M = 1, UNKNOWN_RAD = 1;  // sigma of directions that the pairs do not constrain
constexpr double FREE_M = 0.02;         // of points on the surface: a direction of larger sigma counts as free
constexpr double OBJECT_LEVER_M = 0.1;  // size of an object, by which angles compare with lengths
constexpr double AXIS_DISTANCE_M = 1;   // a rotation about an axis farther away counts as a translation
constexpr int DEPTH_STEP_PX = 16;

/// Information of a pair less the part due to noise: A v = lambda N v gives directions v with lambda, the ratio of
/// their information to the noise's (as in the tracker's dense alignment).
geometry::Matrix6d withoutNoise(const geometry::Matrix6d& A, const geometry::Matrix6d& noise)
{
  const auto information = geometry::informationOverNoise(A, noise);
  if (!information)
    return geometry::Matrix6d::Zero();
  const geometry::Matrix6d U = information->N * information->V;
  const geometry::Vector6d kept = (information->ratios.array() - NOISE_FACTOR).max(0.0);
  return U * kept.asDiagonal() * U.transpose();
}

/// Mean of what a view sees, in the world.
Eigen::Vector3d centerOf(const rgbd::Frame& frame, bool object_only, const Eigen::Isometry3d& T_world_camera)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int v = 0; v < frame.depth_m.rows; v += DEPTH_STEP_PX)
  {
    for (int u = 0; u < frame.depth_m.cols; u += DEPTH_STEP_PX)
    {
      if (!(frame.depthAt_m(u, v) > 0) || (object_only && frame.object_mask.at<std::uint8_t>(v, u) == 0))
        continue;
      sum += frame.point(u, v).cast<double>();
      ++count;
    }
  }
  return T_world_camera * Eigen::Vector3d(sum / std::max(1, count));
}

FreeDirection directionOf(int view, const Eigen::Vector3d& t, const Eigen::Vector3d& r, const Eigen::Vector3d& center)
{
  FreeDirection free;
  free.view = view;
  free.rotation = AXIS_DISTANCE_M * r.norm() > t.norm();
  free.axis_world = (free.rotation ? r : t).normalized();
  if (free.rotation)
    free.point_on_axis_world = center + r.cross(t) / r.squaredNorm();
  return free;
}

/// Motions of one view that its partners resist by no more than noise. (Summed first: the directions that single
/// pairs leave free differ a little, so that together they would seem to resist.)
std::vector<FreeDirection> unresisted(int view, const geometry::Matrix6d& A, const geometry::Matrix6d& noise,
                                      const Eigen::Vector3d& center)
{
  const auto information = geometry::informationOverNoise(A, noise);
  std::vector<FreeDirection> directions;
  for (int i = 0; information && i < 6; ++i)
  {
    if (!(information->ratios[i] < NOISE_FACTOR))
      continue;
    const geometry::Vector6d motion = information->V.col(i);
    const Eigen::Vector3d r = motion.tail<3>();
    directions.push_back(directionOf(view, motion.head<3>() + r.cross(center), r, center));
  }
  return directions;
}

/// Directions of a pose that are not known, given what it sees about `centre` (world).
std::vector<FreeDirection> unknown(int view, const geometry::Matrix6d& covariance, const Eigen::Vector3d& center)
{
  // As displacements: of the centre, and of points OBJECT_LEVER_M from it.
  geometry::Matrix6d to_center = geometry::adjoint(Eigen::Isometry3d(Eigen::Translation3d(-center)));
  to_center.bottomRows<3>() *= OBJECT_LEVER_M;
  const geometry::Matrix6d displacements = to_center * covariance * to_center.transpose();
  const geometry::EigenSystem<6> system = geometry::eigenSystem(displacements);
  std::vector<FreeDirection> directions;
  for (int i = 0; i < 6; ++i)
  {
    if (!(system.values[i] > FREE_M * FREE_M))
      continue;
    const Eigen::Vector3d t = system.vectors.col(i).head<3>();
    const Eigen::Vector3d r = system.vectors.col(i).tail<3>() / OBJECT_LEVER_M;
    directions.push_back(directionOf(view, t, r, center));
  }
  return directions;
}

void reportErrors(const std::vector<rgbd::View>& views, const IcpProblem& problem,
                  const std::vector<Eigen::Isometry3d>& before, const std::vector<Eigen::Isometry3d>& after,
                  MultiViewIcpResult* result)
{
  const std::vector<IcpError> errors_before = problem.errors(before, after),
                              errors_after = problem.errors(after, after);
  std::vector<IcpError> of_before(views.size()), of_after(views.size());
  for (std::size_t e = 0; e < problem.edges().size(); ++e)
  {
    const IcpEdge& edge = problem.edges()[e];
    result->pairs.push_back({ edge.a, edge.b, edge.overlap_ratio, errors_after[e].count, errors_before[e].rmse_m(),
                              errors_after[e].rmse_m() });
    for (const int k : { edge.a, edge.b })
    {
      of_before[k].add(errors_before[e]);
      of_after[k].add(errors_after[e]);
    }
  }
  const std::vector<double> ratios = problem.fittingRatios();
  for (std::size_t k = 0; k < views.size(); ++k)
  {
    result->residuals[k].point_count = of_after[k].count;
    result->residuals[k].rmse_before_m = of_before[k].rmse_m();
    result->residuals[k].rmse_after_m = of_after[k].rmse_m();
    result->residuals[k].inlier_ratio = ratios[k];
  }
}

/// Covariances and free directions, at the outcome.
void reportKnowledge(const std::vector<rgbd::View>& views, const std::vector<int>& bodies, bool object_only,
                     const IcpProblem& problem, const IcpOutcome& outcome, MultiViewIcpResult* result)
{
  std::vector<PairEquations> equations = problem.equations(outcome.T_world_camera);
  const std::vector<geometry::Matrix6d> noise = problem.noise(outcome.T_world_camera);
  IcpError all;
  for (const IcpError& error : problem.errors(outcome.T_world_camera, outcome.T_world_camera))
    all.add(error);
  const double variance = all.weight > 0 ? all.squared_sigmas / all.weight : 1;
  std::vector<geometry::Matrix6d> information_of(views.size(), geometry::Matrix6d::Zero()), noise_of = information_of;
  for (std::size_t e = 0; e < equations.size(); ++e)
  {
    for (const int k : { equations[e].a, equations[e].b })
    {
      information_of[k] += equations[e].A;
      noise_of[k] += noise[e];
    }
    equations[e].A = withoutNoise(equations[e].A, noise[e]) / (CORRELATED_POINTS * std::max(variance, 1e-3));
  }
  geometry::Vector6d prior;
  prior << Eigen::Vector3d::Constant(1 / (UNKNOWN_M * UNKNOWN_M)),
      Eigen::Vector3d::Constant(1 / (UNKNOWN_RAD * UNKNOWN_RAD));
  const std::vector<geometry::Matrix6d> covariances =
      motionCovariances(equations, outcome.members, bodies, prior.asDiagonal());
  for (std::size_t i = 1; i < outcome.members.size(); ++i)
  {
    const int k = outcome.members[i];
    if (!covariances[k].isZero(0))  // equations that cannot be solved give none
      result->covariance[k] = covariances[k];
    const Eigen::Vector3d center = centerOf(views[k].frame, object_only, outcome.T_world_camera[k]);
    std::vector<FreeDirection> free = unresisted(k, information_of[k], noise_of[k], center);
    if (free.empty())
      free = unknown(k, covariances[k], center);
    result->free_directions.insert(result->free_directions.end(), free.begin(), free.end());
  }
}
}  // namespace

MultiViewIcpResult reportOf(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options,
                            const IcpProblem& problem, const IcpOutcome& outcome)
{
  MultiViewIcpResult result;
  result.residuals.resize(views.size());
  for (const rgbd::View& view : views)
  {
    result.T_world_camera.push_back(view.T_world_camera);
    result.covariance.push_back(view.covariance);
  }
  result.rmse_m = outcome.rmse_m;
  result.iterations = static_cast<int>(outcome.rmse_m.size());
  result.converged = outcome.converged;
  const bool possible = !outcome.members.empty();
  for (std::size_t k = 0; k < views.size(); ++k)
    if (!possible || !std::binary_search(outcome.members.begin(), outcome.members.end(), static_cast<int>(k)))
      result.left_out.push_back(static_cast<int>(k));
  if (!possible)
  {
    result.status = { base::StatusCode::NO_RESULT,
                      !options.sessions_as_bodies
                          ? "nothing to align: no two of " + std::to_string(views.size()) +
                                " keyframes see the same surface" + (options.object_only ? " of the object" : "") +
                                " and fit; record more slowly, from closer by, or segment the object first"
                          : "nothing to align: keyframes of different bodies have too little surface in common" };
    if (views.size() == 1)
      result.left_out.clear();
    return result;
  }
  result.last_step_m = outcome.last_step.moved_m;
  result.last_step_rad = outcome.last_step.turned_rad;
  if (!outcome.converged && !options.sessions_as_bodies)
  {
    result.status = { base::StatusCode::NO_RESULT, "multi-view icp did not converge within " +
                                                       std::to_string(result.iterations) +
                                                       " iterations; raise max_iterations" };
    return result;
  }
  reportErrors(views, problem, result.T_world_camera, outcome.T_world_camera, &result);
  result.T_world_camera = outcome.T_world_camera;
  reportKnowledge(views, bodiesOf(views, options), options.object_only, problem, outcome, &result);
  return result;
}

}  // namespace object_modelling::multi_view_icp
