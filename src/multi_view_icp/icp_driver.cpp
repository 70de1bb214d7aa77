#include "icp_driver.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr double FINEST_GATE_M = 0.002;     // below, noise is as large
constexpr double COARSE_NORMAL_RAD = 0.87;  // 50 deg: what a poor pose and a curved surface make of equal normals
constexpr double COARSE_GATE_M = 0.008;     // from there on few points do
constexpr int COARSE_POINT_STEP = 3;
constexpr int MAX_ITERATIONS_PER_GATE = 8;
constexpr double STEP_OF_GATE = 0.05;         // smaller steps than this share of the gate: on to the next
constexpr double CONVERGED_STEP_M = 2e-5;     // of points at the usual distance
constexpr double STABLE_RATIO = 0.003;        // change of the error, over ...
constexpr std::size_t STABLE_ITERATIONS = 4;  // ... as many: what still moves is held by next to nothing
constexpr double SIGHT_LEVER_M = 0.7;         // usual distance from camera to surface
constexpr double MIN_FITTING_RATIO = 0.35;    // of the points in view; fewer, and the view does not fit
constexpr int MAX_TRIALS = 6;                 // of the damping

std::vector<IcpStage> stagesOf(const MultiViewIcpOptions& options)
{
  std::vector<IcpStage> stages;
  for (double gate_m = options.start_error_m; gate_m > FINEST_GATE_M; gate_m /= 2)
  {
    IcpStage stage;
    stage.gate_m = gate_m;
    stage.min_normal_cosine =
        std::cos(gate_m > COARSE_GATE_M ? std::max(COARSE_NORMAL_RAD, options.max_normal_angle_rad)
                                        : options.max_normal_angle_rad);
    stage.color_level = gate_m > COARSE_GATE_M ? 2 : 1;
    stage.point_step = gate_m > COARSE_GATE_M ? COARSE_POINT_STEP : 1;
    stages.push_back(stage);
  }
  stages.push_back({ 0, std::cos(options.max_normal_angle_rad), 0, 1 });
  for (IcpStage& stage : stages)
    stage.rims = !options.sessions_as_bodies;
  return stages;
}

/// How far a motion of a camera, on the left of its pose, moves what it sees.
double displacement_m(const geometry::Vector6d& motion, const Eigen::Isometry3d& T_world_camera)
{
  const Eigen::Vector3d seen = T_world_camera * Eigen::Vector3d(0, 0, SIGHT_LEVER_M);
  return (geometry::isometryFromVector(motion) * seen - seen).norm() + 0.1 * motion.tail<3>().norm();
}

class Solver
{
public:
  /// `few_bodies`: so few that the part of their information that is due to noise is quick to compute.
  Solver(const std::vector<int>& bodies, bool few_bodies, IcpProblem* problem, IcpOutcome* outcome)
      : bodies_(bodies), few_bodies_(few_bodies), problem_(*problem), outcome_(*outcome)
  {
  }

  /// One step that lowers the cost, 0 if there is none.
  IcpStep step()
  {
    const std::vector<PairEquations> equations = problem_.equations(outcome_.T_world_camera);
    std::vector<geometry::Matrix6d> noise;
    if (few_bodies_)
      noise = problem_.noise(outcome_.T_world_camera);
    double cost = 0;
    for (const PairEquations& pair : equations)
      cost += pair.cost;
    for (int trial = 0; trial < MAX_TRIALS; ++trial)
    {
      const auto motions = noise.empty() ? solveMotions(equations, outcome_.members, bodies_, damping_)
                                         : solveResisted(equations, noise, outcome_.members, bodies_, damping_);
      if (motions)
      {
        std::vector<Eigen::Isometry3d> moved = outcome_.T_world_camera;
        IcpStep largest;
        for (const int k : outcome_.members)
        {
          if (bodies_[k] == bodies_[outcome_.members.front()])
            continue;  // stays to the bit
          largest.moved_m = std::max(largest.moved_m, displacement_m((*motions)[k], moved[k]));
          largest.turned_rad = std::max(largest.turned_rad, (*motions)[k].tail<3>().norm());
          moved[k] = geometry::normalized(geometry::isometryFromVector((*motions)[k]) * moved[k]);
        }
        if (problem_.cost(moved) <= cost)
        {
          outcome_.T_world_camera = std::move(moved);
          damping_ = std::max(1e-6, damping_ / 5);
          return largest;
        }
      }
      damping_ = std::min(1e3, damping_ * 8);
    }
    return {};
  }

private:
  const std::vector<int>& bodies_;
  bool few_bodies_;
  IcpProblem& problem_;
  IcpOutcome& outcome_;
  double damping_ = 1e-4;
};

double rmseOf(const std::vector<IcpError>& errors)
{
  IcpError all;
  for (const IcpError& error : errors)
    all.add(error);
  return all.rmse_m();
}

bool stable(const std::vector<double>& rmse_m, std::size_t first)
{
  if (rmse_m.size() < first + STABLE_ITERATIONS)
    return false;
  const auto [low, high] = std::minmax_element(rmse_m.end() - STABLE_ITERATIONS, rmse_m.end());
  return *high - *low <= STABLE_RATIO * *high;
}

/// The member that fits worst, if any does not fit; -1 otherwise.
int misfit(const IcpProblem& problem, const std::vector<int>& members)
{
  const std::vector<double> ratios = problem.fittingRatios();
  const int worst =
      *std::min_element(members.begin(), members.end(), [&](int x, int y) { return ratios[x] < ratios[y]; });
  return members.size() > 2 && ratios[worst] < MIN_FITTING_RATIO ? worst : -1;
}
}  // namespace

IcpOutcome runIcp(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options, IcpProblem* problem,
                  base::JobControl* control)
{
  IcpOutcome outcome;
  std::vector<Eigen::Isometry3d> start;
  for (const rgbd::View& view : views)
    start.push_back(view.T_world_camera);
  outcome.T_world_camera = start;
  const std::vector<int> bodies = bodiesOf(views, options);
  outcome.members = connectedViews(bodies, problem->edges());
  if (outcome.members.empty())
    return outcome;
  const std::vector<IcpStage> stages = stagesOf(options);
  Solver solver(bodies, options.sessions_as_bodies, problem, &outcome);
  IcpOutcome best;  // of the last gate, by error
  const auto refine = [&](const IcpStage& stage)
  {
    const std::size_t first = outcome.rmse_m.size();
    outcome.converged = false;
    for (int i = 0; i < MAX_ITERATIONS_PER_GATE * (stage.gate_m > 0 ? 1 : 3); ++i)
    {
      control->report("multi-view icp", outcome.rmse_m.size(), static_cast<std::size_t>(options.max_iterations));
      if (outcome.rmse_m.size() >= static_cast<std::size_t>(options.max_iterations))
        break;
      problem->match(outcome.T_world_camera, stage);
      outcome.last_step = solver.step();
      const double step_m = outcome.last_step.moved_m;
      outcome.rmse_m.push_back(rmseOf(problem->errors(outcome.T_world_camera, outcome.T_world_camera)));
      outcome.converged = stage.gate_m == 0 && (step_m < CONVERGED_STEP_M || stable(outcome.rmse_m, first));
      if (stage.gate_m == 0 && (best.rmse_m.empty() || outcome.rmse_m.back() < best.rmse_m.back()))
        best = outcome;
      if (outcome.converged || step_m < STEP_OF_GATE * stage.gate_m)
        break;
    }
  };
  for (const IcpStage& stage : stages)
    refine(stage);
  if (options.sessions_as_bodies && !outcome.converged && !best.rmse_m.empty())
  {
    outcome.T_world_camera = best.T_world_camera;
    outcome.last_step = best.last_step;
  }
  for (;;)
  {
    problem->match(outcome.T_world_camera, stages.back());
    const int worst = misfit(*problem, outcome.members);
    if (worst < 0 || options.sessions_as_bodies)  // one of a body stands or falls with the rest
      break;
    problem->leaveOut(worst);
    const std::vector<int> members = connectedViews(bodies, problem->edges());
    for (const int k : outcome.members)
      if (!std::binary_search(members.begin(), members.end(), k))
        outcome.T_world_camera[k] = start[k];
    outcome.members = members;
    if (members.empty())
      break;
    refine(stages.back());
  }
  return outcome;
}

}  // namespace object_modelling::multi_view_icp
