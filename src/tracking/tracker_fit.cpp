#include <algorithm>
#include <unordered_map>

#include "object_modelling/registration/dense_quality.h"
#include "object_modelling/rgbd/pose_certainty.h"
#include "pose_uncertainty.h"
#include "stage_timer.h"
#include "tracker_implementation.h"

// The pose of a frame that is known nearly: what is known where, and the least squares on it. How a frame gets that far
// is in tracker_placement.cpp.
namespace object_modelling::tracking
{
namespace
{
constexpr double LOST_SIGMA = 1;            // m and rad, of a camera that may be anywhere
constexpr double SHAPE_ERROR_RAD = 0.001;   // of rays, where surfaces alone determine the pose
constexpr double TRUSTED_RMSE_RATIO = 0.5;  // of the inlier gate; wrong poses fill the gate evenly, which gives 0.7

int countTrusted(const std::vector<LandmarkMatch>& matches)
{
  return static_cast<int>(
      std::count_if(matches.begin(), matches.end(), [](const LandmarkMatch& match) { return match.trusted; }));
}

/// Quadratic term of a pose by surfaces that fit, and by a prediction where there is one.
registration::QuadraticTerm termOf(const registration::DenseAlignment& aligned, bool surfaces_fit,
                                   const registration::QuadraticTerm* prediction)
{
  registration::QuadraticTerm term;
  term.T_camera_world = aligned.T_world_camera.inverse();
  if (surfaces_fit)
    term.equations = aligned.term.equations;
  // Directions of a lost camera that nothing constrains show as a large covariance.
  if (prediction)
    term.equations += prediction->at(term.T_camera_world);
  else
    term.equations.A += geometry::Matrix6d::Identity() / (LOST_SIGMA * LOST_SIGMA);
  return term;
}

std::string tooFew(int close_count, int predicted_count, int min_inliers, const registration::DenseTerm& surfaces)
{
  return std::to_string(close_count) + " consistent landmarks of " + std::to_string(predicted_count) +
         " that should be in view (at least " + std::to_string(min_inliers) +
         " are needed), and surfaces: " + registration::describe(surfaces);
}

/// What of the map the frame shows near a pose, and landmarks by optical flow where that is less than `enough`. Matches
/// that are not trusted count only of a camera that is not `lost`, and where `enough` others are missing.
MapMatches matchesNear(const KeyframeMap& map, const rgbd::Frame& frame, const registration::ImagePyramid& pyramid,
                       const Eigen::Isometry3d& T_session_camera, const std::vector<LandmarkMatch>& flow,
                       const MapMatchingOptions& options, int enough, bool lost)
{
  std::unordered_map<std::uint64_t, Eigen::Vector2f> flow_pixels;
  for (const LandmarkMatch& match : flow)
    flow_pixels.emplace(match.landmark_id, match.correspondence.pixel.cast<float>());
  MapMatches found = matchMap(map, frame, pyramid, T_session_camera, flow_pixels, options);
  // Optical flow drifts; it counts only where too little of the map is recognised.
  if (static_cast<int>(found.matches.size()) < enough)
  {
    for (const LandmarkMatch& match : found.matches)
      flow_pixels.erase(match.landmark_id);
    for (const LandmarkMatch& match : flow)
      if (flow_pixels.count(match.landmark_id) > 0)
        found.matches.push_back(match);
  }
  // Matches of keyframes placed in doubt do not count where others suffice, and never for a lost camera.
  if (lost || countTrusted(found.matches) >= enough)
    found.matches.erase(std::remove_if(found.matches.begin(), found.matches.end(),
                                       [](const LandmarkMatch& match) { return !match.trusted; }),
                        found.matches.end());
  return found;
}
}  // namespace

registration::PoseEstimationOptions CameraTracker::Implementation::poseOptions(const rgbd::Frame& frame) const
{
  registration::PoseEstimationOptions options;
  // The gate is given for a VGA image, where half a pixel is what patch refinement reaches.
  options.max_reprojection_error_px = options_.max_reprojection_error_px;
  options.noise_model = frame.noise_model;
  return options;
}

CameraTracker::Implementation::Surfaces CameraTracker::Implementation::surfacesNear(
    const View& view, const Eigen::Isometry3d& T_session_camera, StageTimes* times) const
{
  const StageTimer timer(&times->dense_ms);
  Surfaces surfaces;
  surfaces.aligned.T_world_camera = T_session_camera;
  const std::vector<const MapKeyframe*> nearest = map_.nearestViews(T_session_camera, 1);
  if (nearest.empty())
    return surfaces;
  surfaces.reference = nearest.front();
  registration::DenseAlignmentOptions finest;
  finest.coarsest_level = 0;
  finest.max_iterations = 2;
  const registration::DenseAlignment aligned =
      registration::alignDense(surfaces.reference->dense(), surfaces.reference->T_session_camera, view.dense,
                               T_session_camera, geometry::Matrix6d::Zero(), finest);
  if (registration::plausible(aligned.term))
    surfaces.aligned = aligned;
  return surfaces;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeNear(
    const View& view, const Surfaces& surfaces, const std::vector<LandmarkMatch>& flow, double prediction_error_px,
    const registration::QuadraticTerm* prediction, StageTimes* times) const
{
  Placement placement;
  if (!surfaces.reference)
  {
    placement.reason = "no keyframe looks this way";
    return placement;
  }
  placement.reference = surfaces.reference;
  const MapKeyframe& reference = *surfaces.reference;
  const registration::DenseAlignment& aligned = surfaces.aligned;
  const Eigen::Isometry3d& T_session_camera = aligned.T_world_camera;
  const bool surfaces_fit = registration::plausible(aligned.term);
  placement.overlap = aligned.term.overlap;

  const StageTimer map_timer(&times->map_ms);
  MapMatchingOptions matching;
  matching.prediction_error_px = prediction_error_px;
  matching.max_matches = options_.max_features;
  const MapMatches found = matchesNear(map_, view.frame, view.pyramid, T_session_camera, flow, matching,
                                       2 * options_.min_inliers, prediction == nullptr);
  placement.reference_share = found.reference_share;

  const registration::QuadraticTerm term = termOf(aligned, surfaces_fit, prediction);
  placement.pose = registration::refinePose(correspondencesOf(found.matches), view.frame.camera, T_session_camera,
                                            poseOptions(view.frame), &term);
  const bool landmarks_fit =
      placement.pose.valid && placement.pose.close_count >= options_.min_inliers &&
      placement.pose.inlier_count >= options_.min_inlier_ratio * static_cast<double>(found.matches.size());
  if (!placement.pose.valid ||
      (!landmarks_fit &&
       !(surfaces_fit && (prediction ? registration::convincing(aligned.term) : registration::certain(aligned.term)))))
  {
    placement.reason = tooFew(placement.pose.close_count, found.predicted_count, options_.min_inliers, aligned.term);
    placement.pose.valid = false;
    return placement;
  }
  placement.inliers = inliersOf(found.matches, placement.pose);
  const double error_rad = landmarks_fit ? placement.pose.reprojection_rmse_px / view.frame.camera.fx : SHAPE_ERROR_RAD;
  placement.relative_covariance =
      inSessionFrame(placement.pose.covariance + systematicCovariance(reference.median_depth_m, error_rad),
                     placement.pose.T_world_camera);
  if (surfaces.chained)
    placement.relative_covariance += last_covariance_;
  placement.reason = unconstrained(
      rgbd::inCameraFrame(placement.relative_covariance + reference.covariance, placement.pose.T_world_camera),
      reference.median_depth_m);
  if (!placement.reason.empty())
  {
    placement.pose.valid = false;
    return placement;
  }
  const bool landmarks_trusted =
      countTrusted(placement.inliers) == placement.pose.inlier_count &&
      placement.pose.reprojection_rmse_px <= TRUSTED_RMSE_RATIO * options_.max_reprojection_error_px;
  placement.trusted = landmarks_fit ? landmarks_trusted : reference.trusted;
  placement.by_landmarks = landmarks_fit && landmarks_trusted;
  return placement;
}

}  // namespace object_modelling::tracking
