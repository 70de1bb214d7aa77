#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::tracking
{
enum class TrackingStatus : std::uint8_t
{
  NOT_STARTED = 0,  ///< no frame yet that could start a session
  TRACKING = 1,
  LOST = 2,
  RELOCALISED = 3,  ///< first frame that tracks again after a loss
};

enum class Reference : std::uint8_t
{
  SCENE,   ///< all that stands still with respect to the object's support: the whole view
  OBJECT,  ///< features and depth of Frame::trackedMask() alone (turntable, object in motion, static background)
};

struct CameraTrackerOptions
{
  Reference reference = Reference::SCENE;
  int max_features = 300;                  ///< tracked per frame
  int min_inliers = 20;                    ///< fewer geometric inliers: the frame is lost
  double min_inlier_ratio = 0.3;           ///< in [0, 1], of the landmarks found; less: the frame is lost
  double max_reprojection_error_px = 2.5;  ///< inlier gate at the frame's resolution
  double keyframe_angle_rad = 0.20943951;  ///< 12 deg: no stored keyframe views from a direction closer than this ...
  double keyframe_distance_ratio = 0.2;    ///< ... or from within this share of the median depth
  /// Standard deviations of the motion between two frames as a robot measures it; see track().
  double robot_translation_sigma_m = 0.003;
  double robot_rotation_sigma_rad = 0.01;
  std::uint64_t seed = 1;  ///< of every random choice; the same frames and seed give the same poses
  std::vector<std::string> violations() const;
};

/// Wall time that the steps of one frame took.
struct StageTimes
{
  double pyramid_ms = 0;      ///< image pyramids and blur
  double flow_ms = 0;         ///< optical flow and the rough pose
  double map_ms = 0;          ///< patches of the map's landmarks
  double dense_ms = 0;        ///< depth and intensity of all surfaces
  double recognition_ms = 0;  ///< only where the steps above failed
  double keyframe_ms = 0;     ///< making a keyframe of the frame
};

/// Result of tracking one frame.
struct TrackingResult
{
  double stamp_s = 0;
  TrackingStatus status = TrackingStatus::NOT_STARTED;
  std::string reason;  ///< why lost or not started, why a keyframe was refused, that a drift was corrected; empty when
                       ///< all is well
  Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();  ///< valid if tracked()
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();          ///< of T_session_camera
  int feature_count = 0;            ///< landmarks of the last frame; of the first one, its own
  int inlier_count = 0;             ///< landmarks that fit the pose
  double reprojection_rmse_px = 0;  ///< of the inliers
  double speed_m_per_s = 0;
  double angular_speed_rad_per_s = 0;
  double blur_ratio = 0;  ///< 0 sharp .. 1 no detail left, against the session's sharpest frames
  StageTimes times;
  std::optional<rgbd::Keyframe> keyframe;  ///< set when this frame becomes a keyframe; ids count from 0

  bool tracked() const { return status == TrackingStatus::TRACKING || status == TrackingStatus::RELOCALISED; }
};

/// Handheld RGB-D camera tracking: surfaces (depth and intensity; Kerl, Sturm, Cremers 2013) against the keyframe that
/// sees most of the same, so that coming round again closes the loop; landmarks by projective patch refinement (Aldoma
/// et al. 2015, section 3.1); one robust least squares on both and on the predicted motion. Optical flow where that
/// fails, recognition of keyframes after a loss (docs/tracking.md). The session frame is the optical frame of the first
/// keyframe. Not thread safe.
class CameraTracker
{
public:
  explicit CameraTracker(const CameraTrackerOptions& options = {});
  ~CameraTracker();

  /// Tracks the next frame, in time order. A frame whose size differs from the session's, or whose stamp is not newer,
  /// gives LOST with the reason and changes nothing. `T_robot_camera`: pose of the camera by the kinematics of the
  /// robot that carries it, in any frame that is static with respect to the scene; only the motion since the last frame
  /// placed counts, as prediction and as a measurement with the sigmas of the options.
  TrackingResult track(const rgbd::Frame& frame, const std::optional<Eigen::Isometry3d>& T_robot_camera = {});

  /// Forgets everything: the next frame starts a new session.
  void reset();

  /// Continues a stored session: `keyframes` become the map, and the first frame has to relocalise in it.
  void resume(const std::vector<rgbd::Keyframe>& keyframes);

  /// Predicted T_session_camera for a time, by constant velocity; nothing before the first tracked frame.
  std::optional<Eigen::Isometry3d> predict(double stamp_s) const;

private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

const char* toString(TrackingStatus status);

}  // namespace object_modelling::tracking
