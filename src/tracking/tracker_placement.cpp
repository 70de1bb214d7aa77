#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "depth_sampling.h"
#include "relocaliser.h"
#include "stage_timer.h"
#include "tracker_implementation.h"

// How a frame is placed; what follows from it is in tracker_implementation.cpp.
namespace object_modelling::tracking
{
namespace
{
// Faster than a hand moves a camera on purpose; poses that ask for it are wrong.
constexpr double MAX_SPEED_M_PER_S = 4.0;
constexpr double MAX_ANGULAR_SPEED_RAD_PER_S = 12.0;
constexpr double RECOGNITION_ERROR_PX = 4.0;
constexpr double MAX_FLOW_GAP_S = 0.2;
constexpr double FLOW_PREDICTION_ERROR_PX = 1.5;
constexpr double TRUSTED_RMSE_RATIO = 0.5;  // of the inlier gate; wrong poses fill the gate evenly, which gives 0.7

std::vector<LandmarkMatch> inliersOf(const std::vector<LandmarkMatch>& matches, const PoseEstimate& pose)
{
  std::vector<LandmarkMatch> inliers;
  for (std::size_t i = 0; i < matches.size(); ++i)
    if (pose.inliers[i])
      inliers.push_back(matches[i]);
  return inliers;
}

int countTrusted(const std::vector<LandmarkMatch>& matches)
{
  return static_cast<int>(
      std::count_if(matches.begin(), matches.end(), [](const LandmarkMatch& match) { return match.trusted; }));
}

std::vector<Correspondence> correspondencesOf(const std::vector<LandmarkMatch>& matches)
{
  std::vector<Correspondence> correspondences;
  correspondences.reserve(matches.size());
  for (const LandmarkMatch& match : matches)
    correspondences.push_back(match.correspondence);
  return correspondences;
}
}  // namespace

PoseEstimationOptions CameraTracker::Implementation::poseOptions() const
{
  PoseEstimationOptions options;
  // The gate is given for a VGA image, where half a pixel is what patch refinement reaches.
  options.max_reprojection_error_px = options_.max_reprojection_error_px;
  return options;
}

Eigen::Isometry3d CameraTracker::Implementation::predictNow(double stamp_s) const
{
  if (T_robot_camera_ && T_robot_camera_last_)
    return geometry::normalised(*motion_.last() * T_robot_camera_last_->inverse() * *T_robot_camera_);
  return *motion_.predict(stamp_s);
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByFlow(const rgbd::Frame& frame,
                                                                                    const ImagePyramid& pyramid,
                                                                                    StageTimes* times) const
{
  Placement placement;
  // Flow across a longer loss finds accidental fits; only recognition, which is verified, ends it.
  const bool interrupted = lost_ && frame.stamp_s - last_placed_s_ > MAX_FLOW_GAP_S;
  if (last_inliers_.empty() || !motion_.last() || interrupted)
  {
    placement.reason = "no landmarks to follow into this frame";
    return placement;
  }
  StageTimer flow_timer(&times->flow_ms);
  const Eigen::Isometry3d T_session_predicted = predictNow(frame.stamp_s);
  const Eigen::Isometry3d T_predicted_session = T_session_predicted.inverse();
  std::vector<Eigen::Vector2f> from, predicted;
  for (const LandmarkMatch& match : last_inliers_)
  {
    const Eigen::Vector3d p = T_predicted_session * match.correspondence.p_session;
    from.push_back(match.correspondence.pixel.cast<float>());
    predicted.push_back(p.z() > 0.05 ? Eigen::Vector2f(camera_.project(p).cast<float>()) : from.back());
  }
  const std::vector<FlowFeature> flow = trackFlow(last_pyramid_, pyramid, from, predicted);
  std::vector<LandmarkMatch> matches;
  for (std::size_t i = 0; i < flow.size(); ++i)
  {
    if (!flow[i].found)
      continue;
    const Eigen::Vector2f& pixel = flow[i].pixel;
    if (objectOnly() &&
        frame.object_mask.at<std::uint8_t>(static_cast<int>(pixel.y()), static_cast<int>(pixel.x())) == 0)
      continue;
    matches.push_back({ last_inliers_[i].landmark_id,
                        { last_inliers_[i].correspondence.p_session, pixel.cast<double>(),
                          sampleDepth_m(frame.depth_m, pixel.x(), pixel.y()) },
                        last_inliers_[i].trusted });
  }
  const PoseEstimate rough =
      estimatePose(correspondencesOf(matches), frame.camera, T_session_predicted, seed(), poseOptions());
  if (!rough.valid || rough.close_count < options_.min_inliers ||
      rough.inlier_count < options_.min_inlier_ratio * static_cast<double>(last_inliers_.size()))
  {
    placement.reason = "optical flow: " + std::to_string(rough.inlier_count) + " of " +
                       std::to_string(last_inliers_.size()) + " landmarks consistent";
    return placement;
  }
  flow_timer.stop();
  const StageTimer map_timer(&times->map_ms);
  placement = placeByMap(frame, pyramid, rough.T_session_camera, inliersOf(matches, rough), FLOW_PREDICTION_ERROR_PX);
  if (placement.pose.valid)
  {
    placement.reason = implausible(frame, placement.pose.T_session_camera);
    placement.pose.valid = placement.reason.empty();
  }
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByRecognition(
    const rgbd::Frame& frame, const ImagePyramid& pyramid, StageTimes* times) const
{
  const StageTimer timer(&times->recognition_ms);
  const Relocalisation found = relocalise(frame, map_, motion_.last(), seed());
  if (!found.keyframe)
  {
    Placement placement;
    placement.reason = found.reason;
    return placement;
  }
  Placement placement = placeByMap(frame, pyramid, found.pose.T_session_camera, {}, RECOGNITION_ERROR_PX);
  placement.wide_baseline = true;
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByMap(
    const rgbd::Frame& frame, const ImagePyramid& pyramid, const Eigen::Isometry3d& T_session_camera,
    const std::vector<LandmarkMatch>& flow, double prediction_error_px) const
{
  Placement placement;
  std::unordered_map<std::uint64_t, Eigen::Vector2f> flow_pixels;
  for (const LandmarkMatch& match : flow)
    flow_pixels.emplace(match.landmark_id, match.correspondence.pixel.cast<float>());
  MapMatchingOptions matching;
  matching.prediction_error_px = prediction_error_px;
  matching.max_matches = options_.max_features;
  MapMatches found = matchMap(map_, frame, pyramid, T_session_camera, flow_pixels, matching);
  placement.reference_share = found.reference_share;
  // Optical flow drifts; it counts only where too little of the map is recognised.
  if (static_cast<int>(found.matches.size()) < 2 * options_.min_inliers)
  {
    for (const LandmarkMatch& match : found.matches)
      flow_pixels.erase(match.landmark_id);
    for (const LandmarkMatch& match : flow)
      if (flow_pixels.count(match.landmark_id) > 0)
        found.matches.push_back(match);
  }
  // What was placed in doubt has no say where others suffice, and none in where a lost camera is.
  if (flow.empty() || countTrusted(found.matches) >= 2 * options_.min_inliers)
    found.matches.erase(std::remove_if(found.matches.begin(), found.matches.end(),
                                       [](const LandmarkMatch& match) { return !match.trusted; }),
                        found.matches.end());
  placement.pose = refinePose(correspondencesOf(found.matches), frame.camera, T_session_camera, poseOptions());
  if (!placement.pose.valid || placement.pose.close_count < options_.min_inliers ||
      placement.pose.inlier_count < options_.min_inlier_ratio * static_cast<double>(found.matches.size()))
  {
    placement.reason = std::to_string(placement.pose.close_count) + " consistent landmarks of " +
                       std::to_string(found.predicted_count) + " that should be in view (at least " +
                       std::to_string(options_.min_inliers) + " are needed)";
    placement.pose.valid = false;
    return placement;
  }
  placement.inliers = inliersOf(found.matches, placement.pose);
  placement.trusted = countTrusted(placement.inliers) == placement.pose.inlier_count &&
                      placement.pose.reprojection_rmse_px <= TRUSTED_RMSE_RATIO * options_.max_reprojection_error_px;
  return placement;
}

std::string CameraTracker::Implementation::implausible(const rgbd::Frame& frame,
                                                       const Eigen::Isometry3d& T_session_camera) const
{
  const Eigen::Isometry3d T_last_camera = motion_.last()->inverse() * T_session_camera;
  const double elapsed_s = std::max(1e-3, frame.stamp_s - last_placed_s_);
  const double speed_m_per_s = T_last_camera.translation().norm() / elapsed_s;
  const double angular_speed_rad_per_s = geometry::rotationAngle_rad(T_last_camera) / elapsed_s;
  if (speed_m_per_s > MAX_SPEED_M_PER_S || angular_speed_rad_per_s > MAX_ANGULAR_SPEED_RAD_PER_S)
    return "implausible jump of " + std::to_string(speed_m_per_s) + " m/s, " + std::to_string(angular_speed_rad_per_s) +
           " rad/s";
  return {};
}

}  // namespace object_modelling::tracking
