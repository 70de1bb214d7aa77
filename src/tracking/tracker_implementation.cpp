#include "tracker_implementation.h"

#include <algorithm>
#include <cmath>

#include "keyframe_maker.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/depth_in_time.h"
#include "object_modelling/rgbd/depth_sampling.h"
#include "object_modelling/rgbd/surface_fit.h"
#include "stage_timer.h"

namespace object_modelling::tracking
{
namespace
{
constexpr double MIN_REFERENCE_SHARE = 0.4;      // of the reference's landmarks: below it a keyframe is wanted ...
constexpr double LAST_REFERENCE_SHARE = 0.25;    // ... and below this it is taken even from a blurred frame
constexpr double MIN_OVERLAP = 0.6;              // of the reference's surfaces
constexpr std::size_t MIN_SURFACE_POINTS = 500;  // with depth, at a quarter of VGA: enough to begin with ...
constexpr int MIN_EDGE_POINTS = 100;             // ... if there is something to see on them
constexpr double MAX_KEYFRAME_BLUR_RATIO = 0.5;
constexpr double MAX_KEYFRAME_ANGULAR_SPEED_RAD_PER_S = 2.5;
constexpr int MIN_FRAMES_BETWEEN_KEYFRAMES = 3;
constexpr double MIN_DEPTH_SHIFT_PX = 0.25;      // less is no more than the registration is off
constexpr double SHARPNESS_DECAY_RATIO = 0.998;  // per frame, so that a plainer side of the scene becomes the measure
}  // namespace

std::string CameraTracker::Implementation::refuse(const rgbd::Frame& frame) const
{
  const cv::Size size(frame.camera.width, frame.camera.height);
  if (frame.gray.empty() || frame.gray.size() != size || frame.depth_m.size() != size)
    return "images of " + std::to_string(frame.gray.cols) + " x " + std::to_string(frame.gray.rows) + " (grey) and " +
           std::to_string(frame.depth_m.cols) + " x " + std::to_string(frame.depth_m.rows) +
           " px (depth) do not fit the camera's " + std::to_string(size.width) + " x " + std::to_string(size.height) +
           " px";
  if (objectOnly() &&
      (frame.object_mask.empty() || frame.object_mask.size() != size || cv::countNonZero(frame.object_mask) == 0))
    return "frame has no object mask, which tracking by the object needs";
  if (frame_count_ > 0 && !(frame.stamp_s > last_stamp_s_))
    return "stamp " + std::to_string(frame.stamp_s) + " s is not newer than that of the last frame, " +
           std::to_string(last_stamp_s_) + " s";
  if (!map_.empty() && !(frame.camera == camera_))
    return "camera of " + std::to_string(frame.camera.width) + " x " + std::to_string(frame.camera.height) +
           " px differs from that of the session, " + std::to_string(camera_.width) + " x " +
           std::to_string(camera_.height) + " px (size or intrinsics)";
  return {};
}

rgbd::Frame CameraTracker::Implementation::withReferenceMask(rgbd::Frame frame) const
{
  // Masks may come with some frames of a scene too; they do not mark what stands still.
  frame.object_mask = objectOnly() ? frame.trackedMask() : cv::Mat();
  frame.moving_mask.release();
  return frame;
}

TrackingResult CameraTracker::Implementation::track(const rgbd::Frame& given,
                                                    const std::optional<Eigen::Isometry3d>& T_robot_camera)
{
  T_robot_camera_ = T_robot_camera;
  TrackingResult result = trackUsable(withReferenceMask(given));
  if (result.keyframe)
  {
    result.keyframe->frame.object_mask = given.object_mask;
    result.keyframe->frame.moving_mask = given.moving_mask;
  }
  return result;
}

TrackingResult CameraTracker::Implementation::trackUsable(const rgbd::Frame& frame)
{
  TrackingResult result;
  result.stamp_s = frame.stamp_s;
  result.status = map_.empty() ? TrackingStatus::NOT_STARTED : TrackingStatus::LOST;
  result.reason = refuse(frame);
  if (!result.reason.empty())
    return result;
  ++frame_count_;
  ++frames_since_keyframe_;
  last_stamp_s_ = frame.stamp_s;

  StageTimer timer(&result.times.pyramid_ms);
  View view{ frame, registration::ImagePyramid(frame.gray), {} };
  view.dense = registration::DensePyramid(frame, view.pyramid.levels());
  result.blur_ratio = updateBlur(frame, view.pyramid);
  timer.stop();
  if (map_.empty())
  {
    start(view, &result);
    if (!result.tracked())
      return result;
    last_pyramid_ = view.pyramid;
    last_dense_ = view.dense;
    return result;
  }

  result.feature_count = static_cast<int>(last_inliers_.size());
  const Placement placement = place(view, &result.times);
  if (!placement.pose.valid)
  {
    lost_ = true;
    ++lost_frames_;
    result.reason = placement.reason;
    return result;
  }
  result.status = lost_ ? TrackingStatus::RELOCALISED : TrackingStatus::TRACKING;
  if (lost_)
    result.reason = "recognised a known view again";
  else if (placement.corrected)
    result.reason = placement.reason;
  motion_.add(frame.stamp_s, placement.pose.T_world_camera, !lost_ && !placement.corrected);
  T_robot_camera_last_ = T_robot_camera_;
  lost_ = false;
  lost_frames_ = 0;
  previous_placed_s_ = last_placed_s_;
  last_placed_s_ = frame.stamp_s;
  result.T_session_camera = placement.pose.T_world_camera;
  last_covariance_ = placement.relative_covariance;
  result.covariance = placement.relative_covariance + placement.reference->covariance;
  result.inlier_count = placement.pose.inlier_count;
  result.reprojection_rmse_px = placement.pose.reprojection_rmse_px;
  result.speed_m_per_s = motion_.speed_m_per_s();
  result.angular_speed_rad_per_s = motion_.angularSpeed_rad_per_s();
  considerKeyframe(view, placement, &result);
  last_pyramid_ = view.pyramid;
  last_dense_ = view.dense;
  return result;
}

void CameraTracker::Implementation::start(const View& view, TrackingResult* result)
{
  camera_ = view.frame.camera;
  addKeyframe(view, Eigen::Isometry3d::Identity(), {}, true, result);
  result->inlier_count = result->feature_count = static_cast<int>(last_inliers_.size());
  const std::vector<registration::DensePoint>& surface = map_.keyframes().back()->dense().levels().front().all;
  const auto edges =
      std::count_if(surface.begin(), surface.end(), [](const registration::DensePoint& p) { return p.textured; });
  if (result->inlier_count < options_.min_inliers && (surface.size() < MIN_SURFACE_POINTS || edges < MIN_EDGE_POINTS))
  {
    result->reason = "only " + std::to_string(result->inlier_count) + " features with depth in view (at least " +
                     std::to_string(options_.min_inliers) +
                     " are needed): is the lens covered, the scene dark or plain, or the camera nearer than its range?";
    reset();
    result->keyframe.reset();
    return;
  }
  result->status = TrackingStatus::TRACKING;
  T_robot_camera_last_ = T_robot_camera_;
  motion_.add(view.frame.stamp_s, result->T_session_camera, false);
  previous_placed_s_ = last_placed_s_ = view.frame.stamp_s;
}

void CameraTracker::Implementation::considerKeyframe(const View& view, const Placement& placement,
                                                     TrackingResult* result)
{
  last_inliers_ = placement.inliers;
  const bool few_landmarks =
      placement.reference_share < LAST_REFERENCE_SHARE || result->inlier_count < 3 * options_.min_inliers / 2;
  // Too far from all keyframes, a bad one is better than none.
  const bool running_out =
      (few_landmarks && placement.overlap < MIN_OVERLAP) ||
      map_.isNewView(result->T_session_camera, 2 * options_.keyframe_angle_rad, 2 * options_.keyframe_distance_ratio);
  // Wanted when the next frame would see this view from too far away.
  const double step_s = view.frame.stamp_s - previous_placed_s_;
  const bool new_view = map_.isNewView(*motion_.predict(view.frame.stamp_s + step_s), options_.keyframe_angle_rad,
                                       options_.keyframe_distance_ratio);
  const bool poorly_seen = (placement.reference_share < MIN_REFERENCE_SHARE || placement.overlap < MIN_OVERLAP) &&
                           (placement.wide_baseline || frames_since_keyframe_ >= MIN_FRAMES_BETWEEN_KEYFRAMES);
  if (!running_out && !new_view && !poorly_seen)
    return;
  const bool blurred = result->blur_ratio > MAX_KEYFRAME_BLUR_RATIO;
  const bool fast = !objectOnly() && result->angular_speed_rad_per_s > MAX_KEYFRAME_ANGULAR_SPEED_RAD_PER_S;
  if (!running_out && blurred)
    result->reason = "keyframe refused: blurred (" + std::to_string(result->blur_ratio) + "), move slower";
  else if (!running_out && fast)
    result->reason =
        "keyframe refused: turning at " + std::to_string(result->angular_speed_rad_per_s) + " rad/s, move slower";
  else
    addKeyframe(view, result->T_session_camera, placement.inliers, placement.trusted && !blurred && !fast, result);
}

void CameraTracker::Implementation::addKeyframe(const View& view, const Eigen::Isometry3d& T_session_camera,
                                                const std::vector<LandmarkMatch>& matches, bool trusted,
                                                TrackingResult* result)
{
  const StageTimer timer(&result->times.keyframe_ms);
  FeatureDetectorOptions detector;
  detector.max_features = options_.max_features;
  NewKeyframe made = makeKeyframe(next_keyframe_id_++, view.frame, view.pyramid, T_session_camera, matches,
                                  objectOnly(), detector, &next_landmark_id_);
  made.keyframe.covariance = made.map.covariance = result->covariance;
  made.map.trusted = trusted;
  const MapKeyframe& added = map_.add(std::move(made.map));
  result->keyframe = std::move(made.keyframe);
  // The map keeps its depth as it came: that of the frames to be placed there lags alike.
  synchroniseDepth(&*result->keyframe);
  frames_since_keyframe_ = 0;
  last_inliers_.clear();
  for (const Sighting& sighting : added.sightings)
    last_inliers_.push_back(
        { sighting.landmark_id,
          { T_session_camera * sighting.p_keyframe, sighting.pixel.cast<double>(), sighting.p_keyframe.z() },
          trusted });
}

void CameraTracker::Implementation::synchroniseDepth(rgbd::Keyframe* keyframe) const
{
  rgbd::Frame& frame = keyframe->frame;
  const Eigen::Isometry3d T_color_depth = motion_.motion(frame.depth_delay_s);
  frame.depth_delay_s = 0;
  // Of a point 1 m away.
  const double shift_px =
      frame.camera.fx * (geometry::rotationAngle_rad(T_color_depth) + T_color_depth.translation().norm());
  if (shift_px < MIN_DEPTH_SHIFT_PX)
    return;
  frame.depth_m = rgbd::moveDepth(frame.depth_m, frame.camera, T_color_depth);
  for (rgbd::Observation& observation : keyframe->observations)
    observation.depth_m = rgbd::sampleDepth_m(frame.depth_m, observation.pixel.x(), observation.pixel.y());
}

double CameraTracker::Implementation::updateBlur(const rgbd::Frame& frame, const registration::ImagePyramid& pyramid)
{
  const double sharpness = pyramid.sharpness(objectOnly() ? frame.object_mask : cv::Mat());
  sharpest_ = std::max(sharpness, SHARPNESS_DECAY_RATIO * sharpest_);
  return sharpest_ > 0 ? 1 - sharpness / sharpest_ : 0;
}

void CameraTracker::Implementation::reset()
{
  const CameraTrackerOptions options = options_;
  *this = Implementation(options);
}

void CameraTracker::Implementation::resume(const std::vector<rgbd::Keyframe>& keyframes)
{
  reset();
  for (const rgbd::Keyframe& keyframe : keyframes)
  {
    if (keyframe.frame.gray.empty() || keyframe.frame.gray.size() != keyframe.frame.depth_m.size())
      throw base::Error(base::StatusCode::BAD_INPUT, "keyframe " + std::to_string(keyframe.id) +
                                                         " has no images: a session cannot be resumed by it");
    MapKeyframe known;
    known.id = keyframe.id;
    known.T_session_camera = keyframe.T_session_camera;
    known.covariance = keyframe.covariance;
    known.frame = withReferenceMask(keyframe.frame);
    known.pyramid = registration::ImagePyramid(keyframe.frame.gray).copyLevels();
    std::vector<double> depths_m;
    for (const rgbd::Observation& observation : keyframe.observations)
    {
      next_landmark_id_ = std::max(next_landmark_id_, observation.landmark_id + 1);
      const std::optional<rgbd::SurfacePoint> surface =
          rgbd::fitSurface(keyframe.frame, observation.pixel.cast<double>());
      if (!surface)
        continue;
      depths_m.push_back(surface->p.z());
      known.sightings.push_back({ observation.landmark_id, observation.pixel, surface->p, surface->n });
    }
    if (!depths_m.empty())
      known.median_depth_m = base::median(&depths_m);
    next_keyframe_id_ = std::max(next_keyframe_id_, keyframe.id + 1);
    camera_ = keyframe.frame.camera;
    map_.add(std::move(known));
    lost_ = true;
  }
}

}  // namespace object_modelling::tracking
