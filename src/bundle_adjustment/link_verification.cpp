#include "link_verification.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/features/relative_pose.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
// Inliers that prove a match among n candidates: Brown, Lowe, Automatic Panoramic Image Stitching using Invariant
// Features, IJCV 2007, Eq. 9-13; a rigid 3-D motion is stricter than their homography, so this errs on the safe side.
constexpr double MATCHES_BASE = 8.0;
constexpr double MATCHES_SLOPE = 0.3;
// Inliers along a line leave the rotation about it open: their second largest spread must exceed this share of depth.
constexpr double MIN_SPREAD_RATIO = 0.01;
constexpr int SURFACE_STEP_PX = 6;
constexpr int MIN_COMMON_SAMPLES = 20;
// Relative pose error of a link, as share of depth, on top of the sensor's noise.
constexpr double POSE_ALLOWANCE_RATIO = 0.01;

double featureSigma_px(const features::Feature& feature, double sigma_px)
{
  // SIFT localises in proportion to its scale; the finest blobs measure about 4 px across.
  return sigma_px * std::max(1.0, feature.scale_px / 4.0);
}

bool spread(const std::vector<features::PointPair>& pairs, const std::vector<int>& inliers)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i : inliers)
    mean += pairs[i].p_a;
  mean /= static_cast<double>(inliers.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (int i : inliers)
    scatter += (pairs[i].p_a - mean) * (pairs[i].p_a - mean).transpose();
  scatter /= static_cast<double>(inliers.size());
  const Eigen::Vector3d variances = geometry::eigenSystem(scatter).values;
  return std::sqrt(std::max(0.0, variances[1])) > MIN_SPREAD_RATIO * mean.norm();
}

/// Seed of one pair, so that its random draws do not depend on which other pairs are tried.
std::uint64_t pairSeed(std::uint64_t seed, int id_a, int id_b)
{
  return (seed * 1000003u + static_cast<std::uint64_t>(id_a)) * 1000003u + static_cast<std::uint64_t>(id_b);
}

bool insideMask(const rgbd::Frame& frame, int u, int v)
{
  return frame.object_mask.at<std::uint8_t>(v, u) != 0;
}

}  // namespace

double violationRatio(const rgbd::Frame& from, const rgbd::Frame& onto, const Eigen::Isometry3d& T_onto_from,
                      bool object_only)
{
  int violations = 0, agreements = 0;
  for (int v = SURFACE_STEP_PX / 2; v < from.depth_m.rows; v += SURFACE_STEP_PX)
  {
    for (int u = SURFACE_STEP_PX / 2; u < from.depth_m.cols; u += SURFACE_STEP_PX)
    {
      if (!(from.depthAt_m(u, v) > 0) || (object_only && !insideMask(from, u, v)))
        continue;
      const Eigen::Vector3d p = T_onto_from * from.point(u, v).cast<double>();
      if (!(p.z() > 0.05))
        continue;
      const geometry::Projection<double> at = geometry::projectionOf(onto.camera, p, 1);
      if (!at.inside)
        continue;
      const double tolerance_m = 4 * onto.noise_model.axialSigma_m(at.z_m, 0) + POSE_ALLOWANCE_RATIO * at.z_m;
      const rgbd::Visibility seen = rgbd::visibilityOf(at, onto.depth_m, tolerance_m);
      const bool off_object = object_only && !insideMask(onto, at.column, at.row) && seen != rgbd::Visibility::BEHIND;
      if (off_object || seen == rgbd::Visibility::IN_FRONT)
        ++violations;
      else if (seen == rgbd::Visibility::ON)
        ++agreements;
    }
  }
  const int common = violations + agreements;
  return common < MIN_COMMON_SAMPLES ? 1.0 : static_cast<double>(violations) / common;
}

std::optional<VerifiedLink> verifyLink(const std::vector<rgbd::Keyframe>& keyframes,
                                       const std::vector<features::KeyframeFeatures>& features, int a, int b,
                                       const KeyframeLinkerOptions& options)
{
  std::vector<features::DescriptorMatch> matches;
  std::vector<features::PointPair> pairs;
  for (const features::DescriptorMatch& match :
       features::matchFeatures(features[a], features[b], options.max_match_ratio))
  {
    const features::Feature& feature_a = features[a].features[match.a];
    const features::Feature& feature_b = features[b].features[match.b];
    if (!(feature_a.depth_m > 0) || !(feature_b.depth_m > 0))
      continue;
    matches.push_back(match);
    pairs.push_back({ feature_a.p_camera, feature_b.p_camera, featureSigma_px(feature_a, options.sigma_px),
                      featureSigma_px(feature_b, options.sigma_px) });
  }
  const double inliers_needed = std::max<double>(options.min_inliers, MATCHES_BASE + MATCHES_SLOPE * pairs.size());
  if (pairs.size() < inliers_needed)
    return std::nullopt;
  const rgbd::Frame& frame_a = keyframes[a].frame;
  const rgbd::Frame& frame_b = keyframes[b].frame;
  features::RelativePoseOptions pose_options;
  pose_options.seed = pairSeed(options.seed, keyframes[a].id, keyframes[b].id);
  const features::RelativePose pose = features::estimateRelativePose(pairs, frame_a, frame_b, pose_options);
  if (!pose.found || pose.inliers.size() < inliers_needed || !spread(pairs, pose.inliers))
    return std::nullopt;
  if (violationRatio(frame_b, frame_a, pose.T_a_b, options.object_only) > options.max_violation_ratio ||
      violationRatio(frame_a, frame_b, pose.T_a_b.inverse(), options.object_only) > options.max_violation_ratio)
    return std::nullopt;

  VerifiedLink link;
  link.a = a;
  link.b = b;
  link.T_a_b = pose.T_a_b;
  for (int i : pose.inliers)
  {
    const features::Feature& feature_a = features[a].features[matches[i].a];
    const features::Feature& feature_b = features[b].features[matches[i].b];
    link.points.push_back({ matches[i].a, matches[i].b, feature_a.pixel, feature_b.pixel, feature_a.depth_m,
                            feature_b.depth_m, pairs[i].sigma_a_px, pairs[i].sigma_b_px });
  }
  return link;
}

}  // namespace object_modelling::bundle_adjustment
