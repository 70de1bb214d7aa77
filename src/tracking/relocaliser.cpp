#include "relocaliser.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/rgbd/depth_sampling.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::tracking
{
namespace
{
constexpr int MIN_CHECKED_LANDMARKS = 10;
constexpr double DEPTH_AGREEMENT_SIGMAS = 6.0;
constexpr double DEPTH_AGREEMENT_RATIO = 0.02;  // of the depth, for what oblique surfaces and pose noise add

/// Share of a keyframe's landmarks in view at which the frame measures the depth that the pose predicts.
double depthAgreement(const rgbd::Frame& frame, const MapKeyframe& keyframe, const Eigen::Isometry3d& T_session_camera)
{
  const Eigen::Isometry3d T_camera_keyframe = T_session_camera.inverse() * keyframe.T_session_camera;
  int checked = 0;
  int agreeing = 0;
  for (const Sighting& sighting : keyframe.sightings)
  {
    const Eigen::Vector3d p = T_camera_keyframe * sighting.p_keyframe;
    if (p.z() < 0.1)
      continue;
    const double tolerance_m =
        DEPTH_AGREEMENT_SIGMAS * frame.noise_model.axialSigma_m(p.z(), 0) + DEPTH_AGREEMENT_RATIO * p.z();
    const rgbd::Visibility seen =
        rgbd::visibilityOf(geometry::projectionOf(frame.camera, p, 1), frame.depth_m, tolerance_m);
    if (seen == rgbd::Visibility::OUTSIDE || seen == rgbd::Visibility::UNKNOWN)
      continue;
    ++checked;
    agreeing += seen == rgbd::Visibility::ON;
  }
  return checked >= MIN_CHECKED_LANDMARKS ? static_cast<double>(agreeing) / checked : 0.0;
}

std::vector<const MapKeyframe*> candidates(const rgbd::Frame& frame, const KeyframeMap& map,
                                           const std::optional<Eigen::Isometry3d>& T_session_camera_hint,
                                           const RelocaliserOptions& options)
{
  std::vector<const MapKeyframe*> chosen;
  if (T_session_camera_hint)
    for (const MapKeyframe* near : map.nearestViews(*T_session_camera_hint, options.near_candidates))
      if (near->trusted)
        chosen.push_back(near);
  for (const MapKeyframe* similar : map.similarImages(makeThumbnail(frame.gray), options.similar_candidates))
    if (std::find(chosen.begin(), chosen.end(), similar) == chosen.end())
      chosen.push_back(similar);
  return chosen;
}
}  // namespace

Relocalisation relocalise(const rgbd::Frame& frame, const KeyframeMap& map,
                          const std::optional<Eigen::Isometry3d>& T_session_camera_hint, std::uint64_t seed,
                          const RelocaliserOptions& options)
{
  Relocalisation best;
  const WideBaselineFeatures features = detectWideBaselineFeatures(frame, options.features);
  if (static_cast<int>(features.pixels.size()) < options.min_inliers)
  {
    best.reason = "only " + std::to_string(features.pixels.size()) + " features in view: covered, dark or plain";
    return best;
  }
  registration::PoseEstimationOptions pose_options;
  pose_options.max_reprojection_error_px = options.max_reprojection_error_px;
  pose_options.pixel_sigma_px = 1.0;
  pose_options.max_hypotheses = 500;
  pose_options.noise_model = frame.noise_model;
  std::size_t most_matches = 0;
  int most_inliers = 0;
  int detections = 0;
  for (const MapKeyframe* keyframe : candidates(frame, map, T_session_camera_hint, options))
  {
    if (!keyframe->hasFeatures(options.features) && detections++ >= options.max_detections)
      continue;
    const WideBaselineFeatures& known = keyframe->features(options.features);
    std::vector<registration::Correspondence> correspondences;
    for (const features::DescriptorMatch& match : matchFeatures(features, known))
    {
      if (std::isnan(known.depths_m[match.b]))
        continue;
      const Eigen::Vector2f& pixel = known.pixels[match.b];
      correspondences.push_back(
          { keyframe->T_session_camera * frame.camera.unproject(pixel.x(), pixel.y(), known.depths_m[match.b]),
            features.pixels[match.a].cast<double>(), features.depths_m[match.a] });
    }
    most_matches = std::max(most_matches, correspondences.size());
    registration::PoseEstimate pose =
        registration::estimatePose(correspondences, frame.camera, keyframe->T_session_camera, seed, pose_options);
    most_inliers = std::max(most_inliers, pose.inlier_count);
    if (!pose.valid || pose.inlier_count < options.min_inliers ||
        pose.inlier_count < options.min_inlier_ratio * static_cast<double>(correspondences.size()) ||
        depthAgreement(frame, *keyframe, pose.T_world_camera) < options.min_depth_agreement_ratio)
      continue;
    if (!best.keyframe || pose.inlier_count > best.pose.inlier_count)
    {
      best.keyframe = keyframe;
      best.pose = std::move(pose);
    }
    // A clear recognition needs no other candidate.
    if (best.pose.inlier_count >= 3 * options.min_inliers)
      break;
  }
  if (!best.keyframe)
    best.reason = "no keyframe recognised: at best " + std::to_string(most_matches) + " matches, " +
                  std::to_string(most_inliers) + " of them consistent";
  return best;
}

}  // namespace object_modelling::tracking
