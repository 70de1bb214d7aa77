#pragma once

#include "object_modelling/geometry/transform.h"

namespace object_modelling::tracking
{
/// Covariance of a motion on the left of T_camera_session (in the camera frame) as one on the left of T_session_camera
/// (in the session frame), and back.
geometry::Matrix6d inSessionFrame(const geometry::Matrix6d& covariance, const Eigen::Isometry3d& T_session_camera);
geometry::Matrix6d inCameraFrame(const geometry::Matrix6d& covariance, const Eigen::Isometry3d& T_session_camera);

/// What a hand may change of a camera's velocity within a time: covariance of where constant velocity puts it.
geometry::Matrix6d handMotionCovariance(double elapsed_s);

/// The same for a robot that measures its motion.
geometry::Matrix6d robotMotionCovariance(double translation_sigma_m, double rotation_sigma_rad);

/// What neither landmarks nor surfaces tell of: errors that all measurements against one keyframe share (calibration,
/// smooth distortion of depth).
geometry::Matrix6d systematicCovariance(double depth_m);

}  // namespace object_modelling::tracking
