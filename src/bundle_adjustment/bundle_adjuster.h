#pragma once

#include <vector>

#include "bundle_solver.h"
#include "link_consistency.h"
#include "object_modelling/bundle_adjustment/bundle_adjustment.h"

namespace object_modelling::bundle_adjustment
{
/// Fewer common landmarks do not hold two keyframes together.
constexpr int MIN_SHARED = 6;
/// A residual beyond is an outlier, and left out of the RMSE (before and after alike).
constexpr double OUTLIER_SIGMAS = 6.0;

/// What one set of keyframes and landmarks was adjusted from, and to.
struct Adjustment
{
  std::vector<Eigen::Isometry3d> T_session_camera_start;
  std::vector<VerifiedLink> links;
  std::vector<int> members;  ///< keyframes that took part
  std::vector<bool> active;  ///< links that took part
  BundleState state;
  BundleSolverSummary summary;
  int iterations = 0;
};

/// Links the keyframes, adjusts them, and again without the links that contradict the outcome. Keyframes, options and
/// control must outlive it.
class BundleAdjuster
{
public:
  BundleAdjuster(const std::vector<rgbd::Keyframe>& keyframes, const BundleAdjustmentOptions& options,
                 base::JobControl* control);

  Adjustment run();
  /// What the sensor is off by, from landmarks alone; identity where there are too few.
  rgbd::SensorCorrection calibrate();

private:
  void linkLandmarks(Adjustment* adjustment);
  void findLinks(Adjustment* adjustment);
  /// The landmarks of tracker and active links; chooses the members.
  std::vector<SightGroup> groupsOf(Adjustment* adjustment) const;
  void adjust(double min_improvement_ratio, Adjustment* adjustment) const;
  /// Graduated non-convexity: the loss starts as wide as the errors are and narrows, so that a loop that is open by
  /// many sigmas is closed rather than taken for an outlier.
  void approach(int fixed, Adjustment* adjustment) const;
  void solve(int fixed, double min_improvement_ratio, Adjustment* adjustment) const;
  /// Shared landmarks of each pair of keyframes; surfaces count as enough of them.
  Eigen::MatrixXi connections(const std::vector<SightGroup>& groups) const;
  /// Whether any link had to go.
  bool dropContradicting(Adjustment* adjustment) const;

  const std::vector<rgbd::Keyframe>& keyframes_;
  const BundleAdjustmentOptions& options_;
  base::JobControl* control_;
  std::vector<SightGroup> tracked_;
  std::vector<PoseEdge> link_edges_;
  std::vector<SurfaceLink> surface_links_;
};

}  // namespace object_modelling::bundle_adjustment
