#include "object_modelling/refinement/bundle_adjustment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glog/logging.h>

#include "bundle_solver.h"
#include "connectivity.h"
#include "link_consistency.h"
#include "link_tracks.h"
#include "object_modelling/base/options.h"
#include "object_modelling/refinement/keyframe_linker.h"
#include "pose_covariance.h"
#include "sight_filter.h"

namespace object_modelling::refinement
{
namespace
{
// Fewer common landmarks do not hold two keyframes together.
constexpr int MIN_SHARED = 6;
// With as many the tracker's own observations determine the relative pose; matching again adds little.
constexpr int ENOUGH_SHARED = 40;
// Rounds of adjusting, checking the links, dropping those that contradict.
constexpr int MAX_ROUNDS = 4;
// A residual beyond is an outlier, and left out of the RMSE (before and after alike).
constexpr double OUTLIER_SIGMAS = 6.0;
constexpr int COARSE_ITERATIONS = 12;
// Share of the sights by whose error the start is judged, and how many times that a landmark may be off.
constexpr double TYPICAL_SHARE = 0.8;
constexpr double STRAY_FACTOR = 4.0;

using Poses = std::vector<Eigen::Isometry3d>;

Poses posesOf(const std::vector<rgbd::Keyframe>& keyframes)
{
  Poses poses;
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

class WeightedMeanSquare
{
public:
  void add(double value, double weight)
  {
    sum_ += weight * value * value;
    weight_ += weight;
  }
  double root() const { return weight_ > 0 ? std::sqrt(sum_ / weight_) : 0; }

private:
  double sum_ = 0;
  double weight_ = 0;
};

/// The adjustment of one set of keyframes and landmarks, and its outcome.
struct Adjustment
{
  std::vector<int> members;  ///< keyframes that took part
  std::vector<bool> active;  ///< links that took part
  BundleState state;
  BundleSolverSummary summary;
  int iterations = 0;
};

class BundleAdjuster
{
public:
  BundleAdjuster(const std::vector<rgbd::Keyframe>& keyframes, const BundleAdjustmentOptions& options,
                 base::JobControl* control)
      : keyframes_(keyframes),
        options_(options),
        control_(control),
        start_(posesOf(keyframes)),
        tracked_(trackedSights(keyframes, options.pixel_sigma_px, options.object_only))
  {
  }

  BundleAdjustmentResult run()
  {
    if (options_.link_keyframes && keyframes_.size() > 1)
      findLinks();
    Adjustment adjustment;
    adjustment.active.assign(links_.size(), true);
    for (int round = 0; round < MAX_ROUNDS; ++round)
    {
      adjust(&adjustment);
      if (!adjustment.summary.usable || !dropContradicting(&adjustment))
        break;
    }
    return report(adjustment);
  }

private:
  void findLinks()
  {
    const Eigen::MatrixXi shared = sharedLandmarks(tracked_, keyframes_.size());
    // An object fills a small part of the view and turns in large steps: there no number of tracked landmarks is
    // enough.
    const int enough_shared = options_.object_only ? std::numeric_limits<int>::max() : ENOUGH_SHARED;
    links_ = linkKeyframes(keyframes_, shared, enough_shared, linkerOptions(options_), *control_);
    for (const VerifiedLink& link : links_)
      link_edges_.push_back(edgeOfLink(link, keyframes_));
  }

  std::vector<SightGroup> groupsOf(Adjustment* adjustment) const
  {
    std::vector<SightGroup> groups = tracked_;
    const std::vector<SightGroup> linked = linkedSights(links_, adjustment->active);
    groups.insert(groups.end(), linked.begin(), linked.end());
    adjustment->members = largestComponent(sharedLandmarks(groups, keyframes_.size()), MIN_SHARED);
    return restrictTo(adjustment->members, groups);
  }

  void adjust(Adjustment* adjustment)
  {
    groupsOf(adjustment);
    adjustment->summary = {};
    adjustment->state.map = {};
    adjustment->state.T_session_camera = start_;
    if (adjustment->members.size() < 2)
      return;
    const int fixed = adjustment->members.front();
    const auto is_member = [&](int k)
    { return std::binary_search(adjustment->members.begin(), adjustment->members.end(), k); };
    std::vector<PoseEdge> tracker_edges;
    for (const PoseEdge& edge : edgesOfTracker(tracked_, keyframes_, MIN_SHARED))
      if (is_member(edge.a))
        tracker_edges.push_back(edge);
    for (std::size_t i = 0; i < links_.size(); ++i)
      adjustment->active[i] = adjustment->active[i] && is_member(links_[i].a) && is_member(links_[i].b);
    BundleState& state = adjustment->state;
    state.T_session_camera = relaxWithLinks(tracker_edges, link_edges_, fixed, start_, &adjustment->active);
    const std::vector<SightGroup> groups = groupsOf(adjustment);
    state.map = placeLandmarks(groups, keyframes_, state.T_session_camera, options_.min_observations_per_landmark);
    if (state.map.landmarks.empty())
      return;

    approach(fixed, adjustment);
    state.map = placeLandmarks(groups, keyframes_, state.T_session_camera, options_.min_observations_per_landmark);
    if (state.map.landmarks.empty())
      return;
    BundleSolverOptions solver;
    solver.threads = options_.threads;
    solver.loss_width_sigmas = options_.loss_width_sigmas;
    solver.max_iterations = options_.max_iterations;
    adjustment->summary = solveBundle(keyframes_, fixed, solver, *control_, &state);
    adjustment->iterations += adjustment->summary.iterations;
    if (!adjustment->summary.usable)
      return;
    // The loss bounds the pull of an outlier but does not end it, and strays pull together: without them once more.
    state.map = withoutOutliers(state.map, sightErrors_sigmas(keyframes_, state), OUTLIER_SIGMAS,
                                options_.min_observations_per_landmark);
    adjustment->summary = solveBundle(keyframes_, fixed, solver, *control_, &state);
    adjustment->iterations += adjustment->summary.iterations;
  }

  /// Graduated non-convexity: the loss starts as wide as the errors are and narrows, so that a loop that is open by
  /// many sigmas is closed rather than taken for an outlier.
  void approach(int fixed, Adjustment* adjustment)
  {
    BundleState& state = adjustment->state;
    const std::vector<double> errors = sightErrors_sigmas(keyframes_, state);
    const double typical = quantile(errors, TYPICAL_SHARE);
    state.map = withoutStrays(state.map, errors, STRAY_FACTOR * typical);
    BundleSolverOptions solver;
    solver.threads = options_.threads;
    solver.max_iterations = std::min(COARSE_ITERATIONS, options_.max_iterations);
    for (solver.loss_width_sigmas = 2 * typical; solver.loss_width_sigmas > 2 * options_.loss_width_sigmas;
         solver.loss_width_sigmas /= 3)
      adjustment->iterations += solveBundle(keyframes_, fixed, solver, *control_, &state).iterations;
  }

  /// Whether any link had to go.
  bool dropContradicting(Adjustment* adjustment) const
  {
    bool dropped = false;
    for (std::size_t i = 0; i < links_.size(); ++i)
    {
      if (!adjustment->active[i] || supports(links_[i], keyframes_, adjustment->state.T_session_camera))
        continue;
      adjustment->active[i] = false;
      dropped = true;
    }
    return dropped;
  }

  BundleAdjustmentResult report(const Adjustment& adjustment) const
  {
    BundleAdjustmentResult result;
    result.T_session_camera = start_;
    for (const rgbd::Keyframe& keyframe : keyframes_)
    {
      result.covariance.push_back(keyframe.covariance);
      result.residuals.emplace_back();
      result.residuals.back().keyframe_id = keyframe.id;
    }
    const bool possible = adjustment.summary.usable;
    for (std::size_t k = 0; k < keyframes_.size(); ++k)
      if (!possible || !std::binary_search(adjustment.members.begin(), adjustment.members.end(), static_cast<int>(k)))
        result.left_out.push_back(keyframes_[k].id);
    if (!possible)
    {
      result.status = { base::StatusCode::NO_RESULT,
                        "nothing to adjust: no two of " + std::to_string(keyframes_.size()) + " keyframes share " +
                            std::to_string(MIN_SHARED) +
                            " landmarks or could be matched; record more slowly or with more texture in view" };
      if (keyframes_.size() == 1)
        result.left_out.clear();
      return result;
    }
    result.iterations = adjustment.iterations;
    BundleState before{ start_, adjustment.state.map };
    replaceLandmarks(keyframes_, start_, &before.map);
    result.initial_cost = robustCost(keyframes_, options_.loss_width_sigmas, before);
    result.final_cost = robustCost(keyframes_, options_.loss_width_sigmas, adjustment.state);
    if (!adjustment.summary.converged)
    {
      result.status = { base::StatusCode::NO_RESULT, "bundle adjustment did not converge within " +
                                                         std::to_string(options_.max_iterations) +
                                                         " iterations; raise max_iterations" };
      return result;
    }
    result.T_session_camera = adjustment.state.T_session_camera;
    reportResiduals(before, adjustment.state, &result);
    reportLinks(adjustment, &result);
    const std::vector<geometry::Matrix6d> covariance =
        poseCovariances(keyframes_, adjustment.members.front(), options_.loss_width_sigmas, adjustment.state);
    for (int k : adjustment.members)
      result.covariance[k] = covariance[k];
    return result;
  }

  /// Coarse features count less, in proportion to their precision.
  void reportResiduals(const BundleState& before, const BundleState& after, BundleAdjustmentResult* result) const
  {
    std::vector<WeightedMeanSquare> pixel_before(keyframes_.size()), pixel_after(keyframes_.size());
    std::vector<WeightedMeanSquare> depth_before(keyframes_.size()), depth_after(keyframes_.size());
    for (const Sight& sight : after.map.sights)
    {
      const int k = sight.keyframe;
      const SightError error_before = sightError(sight, keyframes_[k].frame.camera, before);
      const SightError error_after = sightError(sight, keyframes_[k].frame.camera, after);
      if (!std::isfinite(error_before.pixel_px) || !std::isfinite(error_after.pixel_px))
        continue;
      ++result->residuals[k].observation_count;
      const double weight = 1 / (sight.sigma_px * sight.sigma_px);
      pixel_before[k].add(error_before.pixel_px, weight);
      pixel_after[k].add(error_after.pixel_px, weight);
      if (!(sight.depth_m > 0))
        continue;
      depth_before[k].add(error_before.depth_m, weight);
      depth_after[k].add(error_after.depth_m, weight);
    }
    for (std::size_t k = 0; k < keyframes_.size(); ++k)
    {
      KeyframeResidual& residual = result->residuals[k];
      residual.reprojection_rmse_before_px = pixel_before[k].root();
      residual.reprojection_rmse_after_px = pixel_after[k].root();
      residual.depth_rmse_before_m = depth_before[k].root();
      residual.depth_rmse_after_m = depth_after[k].root();
    }
  }

  void reportLinks(const Adjustment& adjustment, BundleAdjustmentResult* result) const
  {
    for (std::size_t i = 0; i < links_.size(); ++i)
    {
      const VerifiedLink& link = links_[i];
      const auto difference = [&](const Poses& poses)
      { return link.T_a_b.inverse() * (poses[link.a].inverse() * poses[link.b]); };
      const Eigen::Isometry3d before = difference(start_), after = difference(result->T_session_camera);
      KeyframeLink reported;
      reported.keyframe_a = keyframes_[link.a].id;
      reported.keyframe_b = keyframes_[link.b].id;
      reported.T_a_b = link.T_a_b;
      reported.inlier_count = static_cast<int>(link.points.size());
      reported.translation_error_before_m = before.translation().norm();
      reported.translation_error_after_m = after.translation().norm();
      reported.rotation_error_before_rad = geometry::rotationAngle_rad(before);
      reported.rotation_error_after_rad = geometry::rotationAngle_rad(after);
      (adjustment.active[i] ? result->links : result->rejected_links).push_back(reported);
    }
    if (!result->rejected_links.empty())
      LOG(INFO) << result->rejected_links.size() << " of " << links_.size() << " keyframe links contradict the rest";
  }

  const std::vector<rgbd::Keyframe>& keyframes_;
  const BundleAdjustmentOptions& options_;
  base::JobControl* control_;
  Poses start_;
  std::vector<SightGroup> tracked_;
  std::vector<VerifiedLink> links_;
  std::vector<PoseEdge> link_edges_;
};

}  // namespace

std::vector<std::string> BundleAdjustmentOptions::violations() const
{
  base::OptionsCheck check("bundle_adjustment");
  check.positive("pixel_sigma_px", pixel_sigma_px);
  check.positive("loss_width_sigmas", loss_width_sigmas);
  check.atLeast("min_observations_per_landmark", min_observations_per_landmark, 2);
  check.atLeast("max_iterations", max_iterations, 1);
  check.atLeast("threads", threads, 1);
  return check.violations();
}

BundleAdjustmentResult adjustBundle(const std::vector<rgbd::Keyframe>& keyframes,
                                    const BundleAdjustmentOptions& options, base::JobControl& control)
{
  base::checked(options);
  control.checkCancelled();
  return BundleAdjuster(keyframes, options, &control).run();
}

}  // namespace object_modelling::refinement
