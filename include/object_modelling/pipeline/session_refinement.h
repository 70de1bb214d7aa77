#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/bundle_adjustment/bundle_adjustment.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/multi_view_icp/multi_view_icp.h"
#include "object_modelling/multi_view_icp/pose_comparison.h"

namespace object_modelling::pipeline
{
enum class RefinementMethod
{
  BUNDLE_ADJUSTMENT,
  MULTI_VIEW_ICP,
  BOTH  ///< bundle adjustment, then multi-view ICP from where that ends
};

struct RefinementOptions
{
  RefinementMethod method = RefinementMethod::BOTH;
  bundle_adjustment::BundleAdjustmentOptions bundle_adjustment;
  multi_view_icp::MultiViewIcpOptions multi_view_icp;  ///< after bundle adjustment its start_error_m is AFTER_BUNDLE_M
  std::vector<std::string> violations() const;
};

/// How far surfaces are off, at most, where bundle adjustment has converged.
constexpr double AFTER_BUNDLE_M = 0.005;

/// Poses that were to choose from, and how they fit measurements that no step was fitted to.
struct ComparedPoses
{
  std::string by;  ///< "live" (as they came), or the name of a method
  multi_view_icp::PoseScore score;
};

struct SessionRefinement
{
  /// OK if one of the steps succeeded. If one fails, the other's poses are used; each has its own status. The
  /// message gives the reason where poses of another method than the requested one were taken.
  base::Status status;
  std::vector<int> keyframe_ids;                    ///< of the keyframes, which are multi_view_icp's views
  std::vector<Eigen::Isometry3d> T_session_camera;  ///< of each of them: those that fit best
  std::string chosen = "live";                      ///< which of those compared they are
  std::vector<ComparedPoses> compared;              ///< empty where frames were corrected on the way
  std::optional<bundle_adjustment::BundleAdjustmentResult> bundle_adjustment;
  std::optional<multi_view_icp::MultiViewIcpResult> multi_view_icp;
};

/// Refines the keyframe poses of one stored session and writes them back in one step if that succeeded; never poses
/// that fit worse than those that were there, nor those of two methods where one alone fits better: comparePoses()
/// decides. Where bundle adjustment drives surfaces apart (colour that is not registered to depth), surfaces alone are
/// tried from the poses that came. Sessions that were tracked on their object are refined by it alone. Throws
/// base::Error for store errors, base::Cancelled; the store then stays as it was.
SessionRefinement refineSessionBy(keyframes::SessionStore& store, const std::string& session_id,
                                  RefinementOptions options, base::JobControl& control);

std::string nameOf(RefinementMethod method);
/// The method of that name: "bundle_adjustment", "multi_view_icp" or "both"; INVALID_ARGUMENT for anything else.
RefinementMethod refinementMethodFrom(const std::string& name);

}  // namespace object_modelling::pipeline
