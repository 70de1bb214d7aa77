#pragma once

#include <string>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/registration/pose_estimation.h"

namespace object_modelling::tracking
{
/// Covariance of a motion on the left of T_camera_session (in the camera frame) as one on the left of T_session_camera
/// (in the session frame). rgbd::inCameraFrame is the way back.
geometry::Matrix6d inSessionFrame(const geometry::Matrix6d& covariance, const Eigen::Isometry3d& T_session_camera);

/// What a hand may change of a camera's velocity within a time: covariance of where constant velocity puts it.
geometry::Matrix6d handMotionCovariance(double elapsed_s);

/// The same for a robot that measures its motion.
geometry::Matrix6d robotMotionCovariance(double translation_sigma_m, double rotation_sigma_rad);

/// Errors that the residuals of landmarks and surfaces do not show, since all measurements against one keyframe share
/// them (calibration, smooth distortion of depth, images exposed while the camera moves). `error_rad`: error of the
/// landmarks' rays, of which a part is common to all.
geometry::Matrix6d systematicCovariance(double depth_m, double error_rad);

/// A predicted pose as least squares: what was known before (session frame), and of the motion since (camera frame).
registration::QuadraticTerm predictionTerm(const Eigen::Isometry3d& T_session_camera,
                                           const geometry::Matrix6d& covariance_before,
                                           const geometry::Matrix6d& covariance_of_motion);

/// Whether a pose contradicts a prediction: squared Mahalanobis distance above 50, far beyond all quantiles of
/// chi-squared with 6 degrees of freedom.
bool contradicts(const registration::PoseEstimate& pose, const registration::QuadraticTerm& prediction);

/// Why a pose is not known in all directions, given its covariance in the camera frame; empty if it is.
std::string unconstrained(const geometry::Matrix6d& covariance, double depth_m);

}  // namespace object_modelling::tracking
