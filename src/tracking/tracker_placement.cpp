#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <Eigen/Eigenvalues>

#include "dense_quality.h"
#include "depth_sampling.h"
#include "pose_uncertainty.h"
#include "relocaliser.h"
#include "stage_timer.h"
#include "surface_relocaliser.h"
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
constexpr double MAX_BLIND_S = 0.2;
constexpr double FLOW_PREDICTION_ERROR_PX = 1.5;
constexpr double ALIGNMENT_ERROR_PX = 1.5;
// A direction that is known no better is not known.
constexpr double MAX_TRANSLATION_SIGMA_RATIO = 0.02;  // of the depth
constexpr double MAX_ROTATION_SIGMA_RAD = 0.02;
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

/// Why a pose is not known in all directions; empty if it is.
std::string unconstrained(const geometry::Matrix6d& covariance, double depth_m)
{
  const auto sigma = [](const Eigen::Matrix3d& block)
  { return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block).eigenvalues().z())); };
  const double translation_m = sigma(covariance.topLeftCorner<3, 3>());
  const double rotation_rad = sigma(covariance.bottomRightCorner<3, 3>());
  if (translation_m <= MAX_TRANSLATION_SIGMA_RATIO * depth_m && rotation_rad <= MAX_ROTATION_SIGMA_RAD)
    return {};
  return "the view leaves a direction free (" + std::to_string(static_cast<int>(std::lround(1e3 * translation_m))) +
         " mm, " + std::to_string(static_cast<int>(std::lround(1e3 * rotation_rad))) +
         " mrad unsure): show more shape or print";
}

QuadraticTerm predictionTerm(const Eigen::Isometry3d& T_session_camera, const geometry::Matrix6d& covariance_before,
                             const geometry::Matrix6d& covariance_of_motion)
{
  QuadraticTerm term;
  term.T_camera_session = T_session_camera.inverse();
  term.equations.A = (inCameraFrame(covariance_before, T_session_camera) + covariance_of_motion).inverse();
  return term;
}

/// Whether a pose is where a prediction says it is not: 50 is far beyond all quantiles of chi-squared with 6 degrees of
/// freedom.
bool contradicts(const PoseEstimate& pose, const QuadraticTerm& prediction)
{
  constexpr double MAX_SQUARED_SIGMAS = 50;
  const geometry::Vector6d off =
      geometry::vectorFromIsometry(pose.T_session_camera.inverse() * prediction.T_camera_session.inverse());
  return off.dot(prediction.equations.A * off) > MAX_SQUARED_SIGMAS;
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

QuadraticTerm CameraTracker::Implementation::predictByHand(double stamp_s) const
{
  return predictionTerm(*motion_.predict(stamp_s), last_covariance_, handMotionCovariance(stamp_s - last_placed_s_));
}

std::optional<QuadraticTerm> CameraTracker::Implementation::predictByRobot() const
{
  if (!T_robot_camera_ || !T_robot_camera_last_)
    return std::nullopt;
  return predictionTerm(geometry::normalised(*motion_.last() * T_robot_camera_last_->inverse() * *T_robot_camera_),
                        last_covariance_,
                        robotMotionCovariance(options_.robot_translation_sigma_m, options_.robot_rotation_sigma_rad));
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::place(const View& view, StageTimes* times) const
{
  // What moved on without being seen for longer ends up in accidental fits; only recognition, which is verified, ends
  // such a loss.
  const bool interrupted = lost_ && view.frame.stamp_s - last_placed_s_ > MAX_BLIND_S;
  Placement placement;
  if (motion_.last() && !interrupted)
  {
    const QuadraticTerm by_hand = predictByHand(view.frame.stamp_s);
    const std::optional<QuadraticTerm> by_robot = predictByRobot();
    placement = placeByAlignment(view, by_robot.value_or(by_hand), times);
    // A robot that says what cannot be (wrong frame, clock or calibration) has no say at all.
    if (by_robot && (!placement.pose.valid || contradicts(placement.pose, *by_robot)))
      placement = placeByAlignment(view, by_hand, times);
    if (placement.pose.valid)
      return placement;
    const std::string reason = placement.reason;
    placement = placeByFlow(view, by_hand, times);
    if (placement.pose.valid)
      return placement;
    placement.reason = reason + "; " + placement.reason;
  }
  Placement recognised = placeByRecognition(view, times);
  if (!recognised.pose.valid && !placement.reason.empty())
    recognised.reason = placement.reason + "; " + recognised.reason;
  return recognised;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByAlignment(
    const View& view, const QuadraticTerm& prediction, StageTimes* times) const
{
  StageTimer timer(&times->dense_ms);
  Placement placement;
  const Eigen::Isometry3d T_session_predicted = prediction.T_camera_session.inverse();
  const std::vector<const MapKeyframe*> nearest = map_.nearestViews(T_session_predicted, 1);
  if (nearest.empty())
  {
    placement.reason = "no keyframe looks this way";
    return placement;
  }
  const MapKeyframe& reference = *nearest.front();
  DenseAlignment aligned = alignDense(reference.dense(), reference.T_session_camera, view.dense, T_session_predicted,
                                      prediction.equations.A);
  bool chained = false;
  if (!convincing(aligned.term))
  {
    // The frame before shows most of the same, and a hand that turned back is nearer to where it was.
    const DenseReference last(last_dense_);
    for (const Eigen::Isometry3d& T_start : { T_session_predicted, *motion_.last() })
    {
      const DenseAlignment other = alignDense(last, *motion_.last(), view.dense, T_start, prediction.equations.A);
      if (quality(other.term) <= quality(aligned.term))
        continue;
      aligned = other;
      chained = true;
    }
  }
  timer.stop();
  if (!plausible(aligned.term))
  {
    placement.reason = "surfaces do not fit what was seen before: " + describe(aligned.term);
    return placement;
  }
  Surfaces surfaces = { &reference, aligned, false };
  if (chained)
  {
    surfaces = surfacesNear(view, aligned.T_session_camera, times);
    if (!convincing(surfaces.aligned.term))
      surfaces = { surfaces.reference, aligned, true };
  }
  placement = placeNear(view, surfaces, {}, ALIGNMENT_ERROR_PX, &prediction, times);
  if (placement.pose.valid)
  {
    placement.reason = implausible(view.frame, placement.pose.T_session_camera);
    placement.pose.valid = placement.reason.empty();
  }
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByFlow(const View& view,
                                                                                    const QuadraticTerm& prediction,
                                                                                    StageTimes* times) const
{
  Placement placement;
  if (last_inliers_.empty())
  {
    placement.reason = "no landmarks to follow into this frame";
    return placement;
  }
  StageTimer timer(&times->flow_ms);
  const rgbd::Frame& frame = view.frame;
  std::vector<Eigen::Vector2f> from, predicted;
  for (const LandmarkMatch& match : last_inliers_)
  {
    const Eigen::Vector3d p = prediction.T_camera_session * match.correspondence.p_session;
    from.push_back(match.correspondence.pixel.cast<float>());
    predicted.push_back(p.z() > 0.05 ? Eigen::Vector2f(camera_.project(p).cast<float>()) : from.back());
  }
  const std::vector<FlowFeature> flow = trackFlow(last_pyramid_, view.pyramid, from, predicted);
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
  const PoseEstimate rough = estimatePose(correspondencesOf(matches), frame.camera,
                                          prediction.T_camera_session.inverse(), seed(), poseOptions());
  timer.stop();
  if (!rough.valid || rough.close_count < options_.min_inliers ||
      rough.inlier_count < options_.min_inlier_ratio * static_cast<double>(last_inliers_.size()))
  {
    placement.reason = "optical flow: " + std::to_string(rough.inlier_count) + " of " +
                       std::to_string(last_inliers_.size()) + " landmarks consistent";
    return placement;
  }
  placement = placeNear(view, surfacesNear(view, rough.T_session_camera, times), inliersOf(matches, rough),
                        FLOW_PREDICTION_ERROR_PX, &prediction, times);
  if (placement.pose.valid)
  {
    placement.reason = implausible(frame, placement.pose.T_session_camera);
    placement.pose.valid = placement.reason.empty();
  }
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByRecognition(const View& view,
                                                                                           StageTimes* times) const
{
  StageTimer timer(&times->recognition_ms);
  const std::optional<DenseAlignment> by_surfaces =
      relocaliseBySurfaces(view.dense, makeThumbnail(view.frame.gray), map_, motion_.last());
  if (by_surfaces)
  {
    timer.stop();
    Placement placement = placeNear(view, surfacesNear(view, by_surfaces->T_session_camera, times), {},
                                    ALIGNMENT_ERROR_PX, nullptr, times);
    placement.wide_baseline = true;
    if (placement.pose.valid)
      return placement;
  }
  const StageTimer feature_timer(&times->recognition_ms);
  const Relocalisation found = relocalise(view.frame, map_, motion_.last(), seed());
  if (!found.keyframe)
  {
    Placement placement;
    placement.reason = found.reason;
    return placement;
  }
  Placement placement =
      placeNear(view, surfacesNear(view, found.pose.T_session_camera, times), {}, RECOGNITION_ERROR_PX, nullptr, times);
  placement.wide_baseline = true;
  return placement;
}

CameraTracker::Implementation::Surfaces CameraTracker::Implementation::surfacesNear(
    const View& view, const Eigen::Isometry3d& T_session_camera, StageTimes* times) const
{
  const StageTimer timer(&times->dense_ms);
  Surfaces surfaces;
  surfaces.aligned.T_session_camera = T_session_camera;
  const std::vector<const MapKeyframe*> nearest = map_.nearestViews(T_session_camera, 1);
  if (nearest.empty())
    return surfaces;
  surfaces.reference = nearest.front();
  DenseAlignmentOptions finest;
  finest.coarsest_level = 0;
  finest.max_iterations = 2;
  const DenseAlignment aligned = alignDense(surfaces.reference->dense(), surfaces.reference->T_session_camera,
                                            view.dense, T_session_camera, geometry::Matrix6d::Zero(), finest);
  if (plausible(aligned.term))
    surfaces.aligned = aligned;
  return surfaces;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeNear(
    const View& view, const Surfaces& surfaces, const std::vector<LandmarkMatch>& flow, double prediction_error_px,
    const QuadraticTerm* prediction, StageTimes* times) const
{
  Placement placement;
  if (!surfaces.reference)
  {
    placement.reason = "no keyframe looks this way";
    return placement;
  }
  placement.reference = surfaces.reference;
  const MapKeyframe& reference = *surfaces.reference;
  const DenseAlignment& aligned = surfaces.aligned;
  const Eigen::Isometry3d& T_session_camera = aligned.T_session_camera;
  const bool surfaces_fit = plausible(aligned.term);
  placement.overlap = aligned.term.overlap;

  const StageTimer map_timer(&times->map_ms);
  std::unordered_map<std::uint64_t, Eigen::Vector2f> flow_pixels;
  for (const LandmarkMatch& match : flow)
    flow_pixels.emplace(match.landmark_id, match.correspondence.pixel.cast<float>());
  MapMatchingOptions matching;
  matching.prediction_error_px = prediction_error_px;
  matching.max_matches = options_.max_features;
  MapMatches found = matchMap(map_, view.frame, view.pyramid, T_session_camera, flow_pixels, matching);
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
  if (!prediction || countTrusted(found.matches) >= 2 * options_.min_inliers)
    found.matches.erase(std::remove_if(found.matches.begin(), found.matches.end(),
                                       [](const LandmarkMatch& match) { return !match.trusted; }),
                        found.matches.end());

  QuadraticTerm term;
  term.T_camera_session = T_session_camera.inverse();
  if (surfaces_fit)
    term.equations = aligned.term.equations;
  if (prediction)
    term.equations += prediction->at(term.T_camera_session);
  placement.pose =
      refinePose(correspondencesOf(found.matches), view.frame.camera, T_session_camera, poseOptions(), &term);
  const bool landmarks_fit =
      placement.pose.valid && placement.pose.close_count >= options_.min_inliers &&
      placement.pose.inlier_count >= options_.min_inlier_ratio * static_cast<double>(found.matches.size());
  if (!placement.pose.valid ||
      (!landmarks_fit && !(surfaces_fit && (prediction ? convincing(aligned.term) : certain(aligned.term)))))
  {
    placement.reason = std::to_string(placement.pose.close_count) + " consistent landmarks of " +
                       std::to_string(found.predicted_count) + " that should be in view (at least " +
                       std::to_string(options_.min_inliers) + " are needed), and surfaces: " + describe(aligned.term);
    placement.pose.valid = false;
    return placement;
  }
  placement.reason = unconstrained(placement.pose.covariance, reference.median_depth_m);
  if (!placement.reason.empty())
  {
    placement.pose.valid = false;
    return placement;
  }
  placement.inliers = inliersOf(found.matches, placement.pose);
  placement.relative_covariance = inSessionFrame(
      placement.pose.covariance + systematicCovariance(reference.median_depth_m), placement.pose.T_session_camera);
  if (surfaces.chained)
    placement.relative_covariance += last_covariance_;
  const bool landmarks_trusted =
      countTrusted(placement.inliers) == placement.pose.inlier_count &&
      placement.pose.reprojection_rmse_px <= TRUSTED_RMSE_RATIO * options_.max_reprojection_error_px;
  placement.trusted = landmarks_fit ? landmarks_trusted : reference.trusted;
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
