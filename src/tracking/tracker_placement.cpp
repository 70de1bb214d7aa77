#include <algorithm>
#include <cmath>
#include <limits>

#include "object_modelling/registration/dense_quality.h"
#include "object_modelling/rgbd/depth_sampling.h"
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
// Faster than a hand moves a camera on purpose; poses that imply it are wrong.
constexpr double MAX_SPEED_M_PER_S = 4.0;
constexpr double MAX_ANGULAR_SPEED_RAD_PER_S = 12.0;
constexpr double RECOGNITION_ERROR_PX = 4.0;
constexpr double MAX_BLIND_S = 0.2;
// Less than to the next place that looks the same: the side of a square box.
constexpr double WHERE_LOST_RAD = 0.6;
// In video the next frame is like this one: what takes longer than frames take to come is not tried with each of them.
constexpr double MIN_WIDE_STEP_S = 0.2;
constexpr int ROBUST_EVERY = 5;
constexpr double FLOW_PREDICTION_ERROR_PX = 1.5;
constexpr double ALIGNMENT_ERROR_PX = 1.5;
}  // namespace

registration::QuadraticTerm CameraTracker::Implementation::predictByHand(double stamp_s) const
{
  return predictionTerm(*motion_.predict(stamp_s), last_covariance_, handMotionCovariance(stamp_s - last_placed_s_));
}

std::optional<registration::QuadraticTerm> CameraTracker::Implementation::predictByRobot() const
{
  if (!T_robot_camera_ || !T_robot_camera_last_)
    return std::nullopt;
  return predictionTerm(geometry::normalized(*motion_.last() * T_robot_camera_last_->inverse() * *T_robot_camera_),
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
    const registration::QuadraticTerm by_hand = predictByHand(view.frame.stamp_s);
    const std::optional<registration::QuadraticTerm> by_robot = predictByRobot();
    placement = placeByAlignment(view, by_robot.value_or(by_hand), times);
    // An impossible pose of the robot (wrong frame, clock or calibration) is not used at all.
    if (by_robot && (!placement.pose.valid || contradicts(placement.pose, *by_robot)))
      placement = placeByAlignment(view, by_hand, times);
    if (placement.pose.valid && !placement.trusted && !placement.reference->trusted)
    {
      Placement by_trusted = placeByTrusted(view, placement.pose.T_world_camera, times);
      if (by_trusted.pose.valid && by_trusted.trusted)
        return by_trusted;
    }
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
    const View& view, const registration::QuadraticTerm& prediction, StageTimes* times) const
{
  StageTimer timer(&times->dense_ms);
  Placement placement;
  const Eigen::Isometry3d T_session_predicted = prediction.T_camera_world.inverse();
  const std::vector<const MapKeyframe*> nearest = map_.nearestViews(T_session_predicted, 1);
  if (nearest.empty())
  {
    placement.reason = "no keyframe looks this way";
    return placement;
  }
  const MapKeyframe& reference = *nearest.front();
  registration::DenseAlignment aligned = registration::alignDense(
      reference.dense(), reference.T_session_camera, view.dense, T_session_predicted, prediction.equations.A);
  bool chained = false;
  if (!registration::convincing(aligned.term))
  {
    // The frame before shows most of the same, and a hand that turned back is nearer to where it was. Where it became
    // the reference, it was tried from the prediction already.
    const bool last_is_reference = reference.T_session_camera.matrix() == motion_.last()->matrix();
    std::optional<registration::DenseReference> made;
    if (!last_is_reference)
      made.emplace(last_dense_);
    const registration::DenseReference& last = made ? *made : reference.dense();
    std::vector<Eigen::Isometry3d> starts = { *motion_.last() };
    if (!last_is_reference)
      starts.insert(starts.begin(), T_session_predicted);
    for (const Eigen::Isometry3d& T_start : starts)
    {
      const registration::DenseAlignment other =
          registration::alignDense(last, *motion_.last(), view.dense, T_start, prediction.equations.A);
      if (registration::quality(other.term) <= registration::quality(aligned.term))
        continue;
      aligned = other;
      chained = !last_is_reference;
    }
  }
  timer.stop();
  if (!registration::plausible(aligned.term))
  {
    placement.reason = "surfaces do not fit what was seen before: " + registration::describe(aligned.term);
    return placement;
  }
  Surfaces surfaces = { &reference, aligned, false };
  if (chained)
  {
    surfaces = surfacesNear(view, aligned.T_world_camera, times);
    if (!registration::convincing(surfaces.aligned.term))
      surfaces = { surfaces.reference, aligned, true };
  }
  placement = placeNear(view, surfaces, {}, ALIGNMENT_ERROR_PX, &prediction, times);
  if (placement.pose.valid)
  {
    placement.reason = implausible(view.frame, placement.pose.T_world_camera);
    placement.pose.valid = placement.reason.empty();
  }
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByTrusted(
    const View& view, const Eigen::Isometry3d& T_session_camera, StageTimes* times) const
{
  StageTimer timer(&times->dense_ms);
  const std::vector<const MapKeyframe*> nearest = map_.nearestViews(T_session_camera, 1, true);
  if (nearest.empty())
    return {};
  const MapKeyframe& reference = *nearest.front();
  const registration::DenseAlignment aligned = registration::alignDense(
      reference.dense(), reference.T_session_camera, view.dense, T_session_camera, geometry::Matrix6d::Zero());
  timer.stop();
  if (!registration::certain(aligned.term))
    return {};
  Placement placement = placeNear(view, { &reference, aligned, false }, {}, ALIGNMENT_ERROR_PX, nullptr, times);
  if (!placement.pose.valid)
    return placement;
  placement.corrected = true;
  const double off_mm = 1e3 * (placement.pose.T_world_camera.translation() - T_session_camera.translation()).norm();
  placement.reason =
      "among known views again, " + std::to_string(std::lround(off_mm)) + " mm from where blurred or poor ones had led";
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByFlow(
    const View& view, const registration::QuadraticTerm& prediction, StageTimes* times) const
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
    const Eigen::Vector3d p = prediction.T_camera_world * match.correspondence.p_world;
    from.push_back(match.correspondence.pixel.cast<float>());
    predicted.push_back(p.z() > 0.05 ? Eigen::Vector2f(camera_.project(p).cast<float>()) : from.back());
  }
  const std::vector<registration::FlowFeature> flow =
      registration::trackFlow(last_pyramid_, view.pyramid, from, predicted);
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
                        { last_inliers_[i].correspondence.p_world, pixel.cast<double>(),
                          rgbd::sampleDepth_m(frame.depth_m, pixel.x(), pixel.y()) },
                        last_inliers_[i].trusted });
  }
  const registration::PoseEstimate rough = registration::estimatePose(
      correspondencesOf(matches), frame.camera, prediction.T_camera_world.inverse(), seed(), poseOptions(frame));
  timer.stop();
  if (!rough.valid || rough.close_count < options_.min_inliers ||
      rough.inlier_count < options_.min_inlier_ratio * static_cast<double>(last_inliers_.size()))
  {
    placement.reason = "optical flow: " + std::to_string(rough.inlier_count) + " of " +
                       std::to_string(last_inliers_.size()) + " landmarks consistent";
    return placement;
  }
  placement = placeNear(view, surfacesNear(view, rough.T_world_camera, times), inliersOf(matches, rough),
                        FLOW_PREDICTION_ERROR_PX, &prediction, times);
  if (placement.pose.valid)
  {
    placement.reason = implausible(frame, placement.pose.T_world_camera);
    placement.pose.valid = placement.reason.empty();
  }
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::placeByRecognition(const View& view,
                                                                                           StageTimes* times) const
{
  Placement by_surfaces = recogniseBySurfaces(view, times);
  if (by_surfaces.pose.valid)
    return by_surfaces;
  StageTimer timer(&times->recognition_ms);
  RelocaliserOptions options;
  options.features = FeatureKind::QUICK;
  Relocalisation found = relocalise(view.frame, map_, motion_.last(), seed(), options);
  // By frames that were placed: a covered camera delivers none.
  const double interval_s = last_placed_s_ - previous_placed_s_;
  const bool video = interval_s > 0 && interval_s < MIN_WIDE_STEP_S;
  if (!found.keyframe && (!video || lost_frames_ % ROBUST_EVERY == ROBUST_EVERY - 1))
  {
    options.features = FeatureKind::ROBUST;
    options.max_detections = video ? 1 : std::numeric_limits<int>::max();
    found = relocalise(view.frame, map_, motion_.last(), seed(), options);
  }
  timer.stop();
  if (!found.keyframe)
  {
    by_surfaces.reason += (by_surfaces.reason.empty() ? "" : "; ") + found.reason;
    return by_surfaces;
  }
  Placement placement =
      placeNear(view, surfacesNear(view, found.pose.T_world_camera, times), {}, RECOGNITION_ERROR_PX, nullptr, times);
  placement.wide_baseline = true;
  return placement;
}

CameraTracker::Implementation::Placement CameraTracker::Implementation::recogniseBySurfaces(const View& view,
                                                                                            StageTimes* times) const
{
  StageTimer timer(&times->recognition_ms);
  const std::optional<RecognisedSurfaces> found =
      relocaliseBySurfaces(view.dense, makeThumbnail(view.frame.gray), map_, motion_.last());
  timer.stop();
  if (!found)
    return {};
  Placement placement =
      placeNear(view, surfacesNear(view, found->aligned.T_world_camera, times), {}, ALIGNMENT_ERROR_PX, nullptr, times);
  placement.wide_baseline = true;
  if (!placement.pose.valid)
    return placement;
  const double depth_m = placement.reference->median_depth_m;
  const bool rival_is_where_lost =
      std::any_of(found->rivals.begin(), found->rivals.end(),
                  [&](const Eigen::Isometry3d& T_session_rival) { return isWhereLost(T_session_rival, depth_m); });
  const bool is_where_lost = isWhereLost(placement.pose.T_world_camera, depth_m);
  if ((is_where_lost && !rival_is_where_lost) || (found->rivals.empty() && placement.by_landmarks))
    return placement;
  placement.pose.valid = false;
  placement.reason = "looks like a known view, but other places look the same: ";
  placement.reason +=
      is_where_lost ? "put something textured beside the object and record again" : "go back to where it was lost";
  return placement;
}

bool CameraTracker::Implementation::isWhereLost(const Eigen::Isometry3d& T_session_camera, double depth_m) const
{
  Eigen::Isometry3d T_session_last = motion_.last() ? *motion_.last() : map_.keyframes().back()->T_session_camera;
  if (motion_.last() && T_robot_camera_ && T_robot_camera_last_)
    T_session_last = T_session_last * T_robot_camera_last_->inverse() * *T_robot_camera_;
  const Eigen::Isometry3d T_last_camera = T_session_last.inverse() * T_session_camera;
  return geometry::rotationAngle_rad(T_last_camera) <= WHERE_LOST_RAD &&
         T_last_camera.translation().norm() <= WHERE_LOST_RAD * depth_m;
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
