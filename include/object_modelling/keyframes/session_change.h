#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/keyframes/session.h"

namespace object_modelling::keyframes
{
struct PoseUpdate
{
  int keyframe_id = -1;
  Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of T_session_camera
};

struct MaskUpdate
{
  int keyframe_id = -1;
  cv::Mat object_mask;  ///< CV_8UC1, of the keyframe's size; empty removes it
};

/// What a stage made of a session, and no more: what is not set stays as it is in the store, whoever wrote it.
struct SessionChange
{
  std::vector<PoseUpdate> poses;
  std::vector<MaskUpdate> masks;
  std::optional<std::string> object_id;
  std::optional<bool> reference_is_object, closed;
  std::optional<std::optional<geometry::Plane>> support_plane_session;  ///< set and empty: takes it away
  std::optional<std::optional<Eigen::Isometry3d>> T_model_session;      ///< set and empty: takes it away
  std::optional<rgbd::SensorCalibration> calibration;
  std::optional<std::string> refinement_report;
  std::optional<StageMark> refined, segmented;  ///< set and without `by`: not done any more

  static SessionChange ofPoses(std::vector<PoseUpdate> updates);
  static SessionChange ofMasks(std::vector<MaskUpdate> updates);
  /// Everything of a session but its id, camera frame, start and keyframes.
  static SessionChange toAllOf(const Session& session);
};

}  // namespace object_modelling::keyframes
