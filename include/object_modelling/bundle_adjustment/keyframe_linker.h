#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::bundle_adjustment
{
struct KeyframeLinkerOptions
{
  int max_features = 1000;            ///< per keyframe
  double max_match_ratio = 0.8;       ///< nearest to second nearest descriptor, both ways
  double sigma_px = 0.5;              ///< of a feature of the finest scale
  int min_inliers = 15;               ///< matches that agree with one rigid motion
  double max_view_angle_rad = 0.87;   ///< 50 deg: views further apart show a surface too differently for features
  double min_overlap_ratio = 0.25;    ///< predicted share of the surface that both see
  int max_partners = 5;               ///< per keyframe, of those predicted from the poses
  int appearance_limit = 80;          ///< up to as many keyframes are compared by appearance, all with all
  double max_violation_ratio = 0.15;  ///< share of the common surface of a link where one view sees through the other
  bool object_only = false;
  std::uint64_t seed = 1;
  std::vector<std::string> violations() const;
};

/// The same surface point in two keyframes.
struct LinkedPoint
{
  int feature_a = -1, feature_b = -1;  ///< identify the point within its keyframe, for all links of a run
  Eigen::Vector2d pixel_a = Eigen::Vector2d::Zero(), pixel_b = Eigen::Vector2d::Zero();
  double depth_a_m = 0, depth_b_m = 0;
  double sigma_a_px = 0, sigma_b_px = 0;  ///< of the pixels
};

/// Two keyframes, by index in the list given, whose features agree with one rigid motion.
struct VerifiedLink
{
  int a = -1, b = -1;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  std::vector<LinkedPoint> points;
};

/// Matches keyframes directly: pairs that by their poses see the same surface (with a generous allowance for drift),
/// pairs that look alike (small sessions), and the first with the last. Pairs with at least `enough_shared` landmarks
/// in `shared` (symmetric counts, by index) are linked already and not tried. Links are ordered by (a, b).
std::vector<VerifiedLink> linkKeyframes(const std::vector<rgbd::Keyframe>& keyframes, const Eigen::MatrixXi& shared,
                                        int enough_shared, const KeyframeLinkerOptions& options,
                                        base::JobControl& control);

}  // namespace object_modelling::bundle_adjustment
