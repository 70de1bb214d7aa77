#include "pose_uncertainty.h"

#include <algorithm>

#include <Eigen/Dense>

#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/rgbd/pose_certainty.h"

namespace object_modelling::tracking
{
namespace
{
// Hands that turn back at once: half of it times the time squared is off the prediction.
constexpr double ACCELERATION_M_PER_S2 = 10;
constexpr double ANGULAR_ACCELERATION_RAD_PER_S2 = 50;
constexpr double SHARED_RATIO = 1.0;       // of the rays' errors
constexpr double MIN_SHARED_RAD = 0.0003;  // of rotation; times depth, of translation

geometry::Matrix6d isotropic(double translation_sigma_m, double rotation_sigma_rad)
{
  geometry::Vector6d variances;
  variances << Eigen::Vector3d::Constant(translation_sigma_m * translation_sigma_m),
      Eigen::Vector3d::Constant(rotation_sigma_rad * rotation_sigma_rad);
  return variances.asDiagonal();
}

}  // namespace

geometry::Matrix6d inSessionFrame(const geometry::Matrix6d& covariance, const Eigen::Isometry3d& T_session_camera)
{
  return rgbd::inCameraFrame(covariance, T_session_camera.inverse());
}

geometry::Matrix6d handMotionCovariance(double elapsed_s)
{
  const double half_square_s2 = 0.5 * elapsed_s * elapsed_s;
  return isotropic(ACCELERATION_M_PER_S2 * half_square_s2, ANGULAR_ACCELERATION_RAD_PER_S2 * half_square_s2);
}

geometry::Matrix6d robotMotionCovariance(double translation_sigma_m, double rotation_sigma_rad)
{
  return isotropic(translation_sigma_m, rotation_sigma_rad);
}

geometry::Matrix6d systematicCovariance(double depth_m, double error_rad)
{
  const double shared_rad = std::max(MIN_SHARED_RAD, SHARED_RATIO * error_rad);
  return isotropic(shared_rad * depth_m, shared_rad);
}

registration::QuadraticTerm predictionTerm(const Eigen::Isometry3d& T_session_camera,
                                           const geometry::Matrix6d& covariance_before,
                                           const geometry::Matrix6d& covariance_of_motion)
{
  registration::QuadraticTerm term;
  term.T_camera_world = T_session_camera.inverse();
  term.equations.A =
      geometry::inverseOf(rgbd::inCameraFrame(covariance_before, T_session_camera) + covariance_of_motion);
  return term;
}

bool contradicts(const registration::PoseEstimate& pose, const registration::QuadraticTerm& prediction)
{
  constexpr double MAX_SQUARED_SIGMAS = 50;
  const geometry::Vector6d off =
      geometry::vectorFromIsometry(pose.T_world_camera.inverse() * prediction.T_camera_world.inverse());
  return off.dot(prediction.equations.A * off) > MAX_SQUARED_SIGMAS;
}

std::string unconstrained(const geometry::Matrix6d& covariance, double depth_m)
{
  const rgbd::PoseSigma sigma = rgbd::poseSigma(covariance);
  if (sigma.isKnown(depth_m))
    return {};
  return "the view leaves a direction free (" + sigma.text() + " unsure): show more shape or texture";
}

}  // namespace object_modelling::tracking
