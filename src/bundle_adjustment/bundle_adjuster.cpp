#include "bundle_adjuster.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "link_tracks.h"
#include "object_modelling/base/connectivity.h"
#include "object_modelling/base/statistics.h"
#include "sight_filter.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
// With as many the tracker's own observations determine the relative pose; matching again adds little.
constexpr int ENOUGH_SHARED = 40;
// Rounds of adjusting, checking the links, dropping those that contradict.
constexpr int MAX_ROUNDS = 4;
constexpr int COARSE_ITERATIONS = 12;
// Share of the cost that an iteration must save: while outliers take part, and at the end.
constexpr double ROUGH_IMPROVEMENT_RATIO = 1e-4, IMPROVEMENT_RATIO = 1e-5;
// Share of the sights by whose error the start is judged, and how many times that a landmark may be off.
constexpr double TYPICAL_SHARE = 0.8;
constexpr double STRAY_FACTOR = 4.0;

std::vector<Eigen::Isometry3d> posesOf(const std::vector<rgbd::Keyframe>& keyframes)
{
  std::vector<Eigen::Isometry3d> poses;
  for (const rgbd::Keyframe& keyframe : keyframes)
  {
    if (!keyframe.T_session_camera.matrix().allFinite())
    {
      throw base::Error(base::StatusCode::INVALID_ARGUMENT, "keyframe " + std::to_string(keyframe.id) +
                                                                " has a pose that is not finite; delete it or give it "
                                                                "a pose");
    }
    poses.push_back(keyframe.T_session_camera);
  }
  return poses;
}

KeyframeLinkerOptions linkerOptions(const BundleAdjustmentOptions& options)
{
  KeyframeLinkerOptions result;
  result.sigma_px = options.pixel_sigma_px;
  result.object_only = options.object_only;
  result.seed = options.seed;
  return result;
}

/// Groups without the sights of keyframes that are not `members`.
std::vector<SightGroup> restrictTo(const std::vector<int>& members, const std::vector<SightGroup>& groups)
{
  std::vector<SightGroup> result;
  for (const SightGroup& group : groups)
  {
    SightGroup kept;
    for (const Sight& sight : group.sights)
      if (std::binary_search(members.begin(), members.end(), sight.keyframe))
        kept.sights.push_back(sight);
    if (kept.sights.size() > 1)
      result.push_back(std::move(kept));
  }
  return result;
}
}  // namespace

BundleAdjuster::BundleAdjuster(const std::vector<rgbd::Keyframe>& keyframes, const BundleAdjustmentOptions& options,
                               base::JobControl* control)
    : keyframes_(keyframes),
      options_(options),
      control_(control),
      tracked_(trackedSights(keyframes, options.pixel_sigma_px, options.object_only))
{
}

Adjustment BundleAdjuster::run()
{
  Adjustment adjustment;
  adjustment.T_session_camera_start = posesOf(keyframes_);
  if (options_.link_keyframes && keyframes_.size() > 1)
    findLinks(&adjustment);
  adjustment.active.assign(adjustment.links.size(), true);
  for (int round = 0; round < MAX_ROUNDS; ++round)
  {
    adjust(IMPROVEMENT_RATIO, &adjustment);
    if (!adjustment.summary.usable || !dropContradicting(&adjustment))
      break;
  }
  return adjustment;
}

rgbd::SensorCorrection BundleAdjuster::calibrate()
{
  Adjustment adjustment;
  adjustment.T_session_camera_start = posesOf(keyframes_);
  if (options_.link_keyframes && keyframes_.size() > 1)
    linkLandmarks(&adjustment);
  adjustment.active.assign(adjustment.links.size(), true);
  for (int round = 0; round < MAX_ROUNDS; ++round)
  {
    adjust(IMPROVEMENT_RATIO, &adjustment);
    if (!adjustment.summary.usable || !dropContradicting(&adjustment))
      break;
  }
  return adjustment.summary.usable ? adjustment.state.sensor : rgbd::SensorCorrection{};
}

void BundleAdjuster::linkLandmarks(Adjustment* adjustment)
{
  const Eigen::MatrixXi shared = sharedLandmarks(tracked_, keyframes_.size());
  // An object fills a small part of the view and turns in large steps: there no number of tracked landmarks is
  // enough.
  const int enough_shared = options_.object_only ? std::numeric_limits<int>::max() : ENOUGH_SHARED;
  adjustment->links = linkKeyframes(keyframes_, shared, enough_shared, linkerOptions(options_), *control_);
  for (const VerifiedLink& link : adjustment->links)
    link_edges_.push_back(edgeOfLink(link, keyframes_));
}

void BundleAdjuster::findLinks(Adjustment* adjustment)
{
  linkLandmarks(adjustment);
  // Surfaces are aligned by their grey levels too; near the offset, what it does to them is proportional to it.
  if (options_.calibrate_color_offset)
  {
    adjustment->active.assign(adjustment->links.size(), true);
    adjust(ROUGH_IMPROVEMENT_RATIO, adjustment);
  }
  surface_links_ = linkSurfaces(keyframes_, adjustment->state.color_offset_px, options_.calibrate_color_offset,
                                options_.object_only, *control_);
}

Eigen::MatrixXi BundleAdjuster::connections(const std::vector<SightGroup>& groups) const
{
  Eigen::MatrixXi shared = sharedLandmarks(groups, keyframes_.size());
  for (const SurfaceLink& link : surface_links_)
  {
    shared(link.a, link.b) += MIN_SHARED;
    shared(link.b, link.a) += MIN_SHARED;
  }
  return shared;
}

std::vector<SightGroup> BundleAdjuster::groupsOf(Adjustment* adjustment) const
{
  std::vector<SightGroup> groups = tracked_;
  const std::vector<SightGroup> linked = linkedSights(adjustment->links, adjustment->active);
  groups.insert(groups.end(), linked.begin(), linked.end());
  adjustment->members = base::largestComponent(connections(groups), MIN_SHARED);
  return restrictTo(adjustment->members, groups);
}

void BundleAdjuster::adjust(double min_improvement_ratio, Adjustment* adjustment) const
{
  groupsOf(adjustment);
  adjustment->summary = {};
  BundleState& state = adjustment->state;
  state.map = {};
  state.T_session_camera = adjustment->T_session_camera_start;
  if (adjustment->members.size() < 2)
    return;
  const int fixed = adjustment->members.front();
  const auto is_member = [&](int k)
  { return std::binary_search(adjustment->members.begin(), adjustment->members.end(), k); };
  state.surface_links.clear();
  std::vector<PoseEdge> tracker_edges;
  std::set<std::pair<int, int>> by_surfaces;
  for (const SurfaceLink& link : surface_links_)
  {
    if (!is_member(link.a) || !is_member(link.b))
      continue;
    state.surface_links.push_back(link);
    tracker_edges.push_back(edgeOfSurfaces(link, keyframes_));
    by_surfaces.emplace(link.a, link.b);
  }
  // What the tracker made of few landmarks is what the surfaces are there to correct.
  const Eigen::MatrixXi shared = sharedLandmarks(tracked_, keyframes_.size());
  for (const PoseEdge& edge : edgesOfTracker(tracked_, keyframes_, MIN_SHARED))
    if (is_member(edge.a) &&
        (shared(edge.a, edge.b) >= ENOUGH_SHARED || by_surfaces.count(std::minmax(edge.a, edge.b)) == 0))
      tracker_edges.push_back(edge);
  for (std::size_t i = 0; i < adjustment->links.size(); ++i)
    adjustment->active[i] =
        adjustment->active[i] && is_member(adjustment->links[i].a) && is_member(adjustment->links[i].b);
  state.T_session_camera =
      relaxWithLinks(tracker_edges, link_edges_, fixed, adjustment->T_session_camera_start, &adjustment->active);
  const std::vector<SightGroup> groups = groupsOf(adjustment);
  state.map = placeLandmarks(groups, keyframes_, state.T_session_camera, options_.min_observations_per_landmark);
  if (state.map.landmarks.empty() && state.surface_links.empty())
    return;

  approach(fixed, adjustment);
  state.map = placeLandmarks(groups, keyframes_, state.T_session_camera, options_.min_observations_per_landmark);
  if (!state.map.landmarks.empty() || !state.surface_links.empty())
    solve(fixed, min_improvement_ratio, adjustment);
}

void BundleAdjuster::approach(int fixed, Adjustment* adjustment) const
{
  BundleState& state = adjustment->state;
  const std::vector<double> errors = sightErrors_sigmas(keyframes_, state);
  if (errors.empty())
    return;
  const double typical = base::quantile(errors, TYPICAL_SHARE);
  state.map = withoutStrays(state.map, errors, STRAY_FACTOR * typical);
  BundleSolverOptions solver;
  solver.threads = options_.threads;
  solver.max_iterations = std::min(COARSE_ITERATIONS, options_.max_iterations);
  for (solver.loss_width_sigmas = 2 * typical; solver.loss_width_sigmas > 2 * options_.loss_width_sigmas;
       solver.loss_width_sigmas /= 3)
    adjustment->iterations += solveBundle(keyframes_, fixed, solver, *control_, &state).iterations;
}

void BundleAdjuster::solve(int fixed, double min_improvement_ratio, Adjustment* adjustment) const
{
  BundleState& state = adjustment->state;
  BundleSolverOptions solver;
  solver.threads = options_.threads;
  solver.loss_width_sigmas = options_.loss_width_sigmas;
  solver.max_iterations = options_.max_iterations;
  solver.calibrate_color_offset = options_.calibrate_color_offset;
  solver.calibrate_intrinsics = options_.calibrate_intrinsics;
  solver.calibrate_depth_ratio = options_.calibrate_depth_ratio;
  solver.calibrate_depth_offset = options_.calibrate_depth_offset;
  solver.calibrate_depth_distortion = options_.calibrate_depth_distortion;
  fitDepths(keyframes_, &state.map);
  solver.min_improvement_ratio = ROUGH_IMPROVEMENT_RATIO;
  adjustment->summary = solveBundle(keyframes_, fixed, solver, *control_, &state);
  adjustment->iterations += adjustment->summary.iterations;
  if (!adjustment->summary.usable)
    return;
  // The loss bounds the pull of an outlier but does not end it, and strays pull together: without them once more.
  solver.min_improvement_ratio = min_improvement_ratio;
  state.map = withoutOutliers(state.map, sightErrors_sigmas(keyframes_, state), OUTLIER_SIGMAS,
                              options_.min_observations_per_landmark);
  adjustment->summary = solveBundle(keyframes_, fixed, solver, *control_, &state);
  adjustment->iterations += adjustment->summary.iterations;
}

bool BundleAdjuster::dropContradicting(Adjustment* adjustment) const
{
  bool dropped = false;
  for (std::size_t i = 0; i < adjustment->links.size(); ++i)
  {
    if (!adjustment->active[i] || supports(adjustment->links[i], keyframes_, adjustment->state.T_session_camera))
      continue;
    adjustment->active[i] = false;
    dropped = true;
  }
  return dropped;
}

}  // namespace object_modelling::bundle_adjustment
