#pragma once

#include <optional>
#include <string>
#include <vector>

#include "keyframe_map.h"
#include "map_matching.h"
#include "motion_model.h"
#include "object_modelling/registration/dense_alignment.h"
#include "object_modelling/registration/pose_estimation.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling::tracking
{
/// State and steps behind CameraTracker.
class CameraTracker::Implementation
{
public:
  explicit Implementation(const CameraTrackerOptions& options) : options_(options) {}

  TrackingResult track(const rgbd::Frame& frame, const std::optional<Eigen::Isometry3d>& T_robot_camera);
  void reset();
  void resume(const std::vector<rgbd::Keyframe>& keyframes);
  std::optional<Eigen::Isometry3d> predict(double stamp_s) const { return motion_.predict(stamp_s); }

private:
  /// A frame with all that is made of it once.
  struct View
  {
    const rgbd::Frame& frame;
    registration::ImagePyramid pyramid;
    registration::DensePyramid dense;
  };

  /// A frame that has been placed, or why it has not.
  struct Placement
  {
    registration::PoseEstimate pose;     ///< valid if placed
    std::vector<LandmarkMatch> inliers;  ///< what the pose rests on beside the surfaces
    const MapKeyframe* reference = nullptr;
    geometry::Matrix6d relative_covariance =
        geometry::Matrix6d::Zero();  ///< session frame; without the reference's own
    double reference_share = 0;      ///< of its landmarks that were found
    double overlap = 0;              ///< of its surfaces that are in view
    bool wide_baseline = false;      ///< found without the frames before
    bool corrected = false;          ///< back among trusted keyframes: off where the motion led
    bool trusted = false;            ///< a good fit to trusted keyframes
    bool by_landmarks = false;       ///< enough of them fit well, whether the surfaces do or not
    std::string reason;
  };

  /// A pose and how the surfaces of a keyframe fit there.
  struct Surfaces
  {
    const MapKeyframe* reference = nullptr;  ///< null if none looks this way
    registration::DenseAlignment aligned;
    bool chained = false;  ///< aligned with the frame before instead
  };

  /// With what it is tracked against as its object mask; empty for all of it.
  rgbd::Frame withReferenceMask(rgbd::Frame frame) const;
  /// track() for a frame whose object mask, if any, counts.
  TrackingResult trackUsable(const rgbd::Frame& frame);
  /// Moves the depth to where the camera was when it took the colour image.
  void synchroniseDepth(rgbd::Keyframe* keyframe) const;
  std::string refuse(const rgbd::Frame& frame) const;
  Placement place(const View& view, StageTimes* times) const;

  /// Predicted pose of the camera: by constant velocity, or by the robot's motion where that is given.
  registration::QuadraticTerm predictByHand(double stamp_s) const;
  std::optional<registration::QuadraticTerm> predictByRobot() const;

  Placement placeByAlignment(const View& view, const registration::QuadraticTerm& prediction, StageTimes* times) const;
  /// A frame that was placed in doubt by keyframes in doubt, by the trusted ones that see the same; not valid if none
  /// does.
  Placement placeByTrusted(const View& view, const Eigen::Isometry3d& T_session_camera, StageTimes* times) const;
  Placement placeByFlow(const View& view, const registration::QuadraticTerm& prediction, StageTimes* times) const;
  Placement placeByRecognition(const View& view, StageTimes* times) const;
  /// By dense alignment with keyframes that look alike or are near; not valid where another place looks the same.
  Placement recogniseBySurfaces(const View& view, StageTimes* times) const;
  /// Whether a pose is near where the camera was last, or where a robot has carried it since; in a resumed session,
  /// near the last keyframe.
  bool isWhereLost(const Eigen::Isometry3d& T_session_camera, double depth_m) const;
  /// Surfaces of the nearest keyframe at the finest level, from a pose that is close.
  Surfaces surfacesNear(const View& view, const Eigen::Isometry3d& T_session_camera, StageTimes* times) const;
  /// From a pose near by: the map's landmarks, and least squares on them, the surfaces and the prediction (may be
  /// null). `flow` are inliers of optical flow.
  Placement placeNear(const View& view, const Surfaces& surfaces, const std::vector<LandmarkMatch>& flow,
                      double prediction_error_px, const registration::QuadraticTerm* prediction,
                      StageTimes* times) const;
  std::string implausible(const rgbd::Frame& frame, const Eigen::Isometry3d& T_session_camera) const;

  void start(const View& view, TrackingResult* result);
  /// Decides on a keyframe; gives why a wanted one was refused.
  void considerKeyframe(const View& view, const Placement& placement, TrackingResult* result);
  void addKeyframe(const View& view, const Eigen::Isometry3d& T_session_camera,
                   const std::vector<LandmarkMatch>& matches, bool trusted, TrackingResult* result);
  double updateBlur(const rgbd::Frame& frame, const registration::ImagePyramid& pyramid);
  std::uint64_t seed() const { return options_.seed * 1000003 + frame_count_; }
  bool objectOnly() const { return options_.reference == Reference::OBJECT; }
  registration::PoseEstimationOptions poseOptions(const rgbd::Frame& frame) const;

  CameraTrackerOptions options_;
  KeyframeMap map_;
  MotionModel motion_;
  geometry::PinholeCamera camera_;
  double last_stamp_s_ = 0;
  int lost_frames_ = 0;  ///< since the last one that was placed
  std::uint64_t frame_count_ = 0;
  std::uint64_t next_landmark_id_ = 0;
  int next_keyframe_id_ = 0;
  int frames_since_keyframe_ = 0;
  bool lost_ = false;
  double sharpest_ = 0;
  registration::ImagePyramid last_pyramid_;  ///< of the last frame that was placed
  registration::DensePyramid last_dense_;    ///< of the same
  double last_placed_s_ = 0;
  double previous_placed_s_ = 0;
  std::vector<LandmarkMatch> last_inliers_;                          ///< landmarks followed by optical flow
  geometry::Matrix6d last_covariance_ = geometry::Matrix6d::Zero();  ///< Placement::relative_covariance
  std::optional<Eigen::Isometry3d> T_robot_camera_;                  ///< of this frame
  std::optional<Eigen::Isometry3d> T_robot_camera_last_;             ///< of the last frame that was placed
};

}  // namespace object_modelling::tracking
