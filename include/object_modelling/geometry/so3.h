#pragma once

#include <cmath>

#include <Eigen/Geometry>

namespace object_modelling::geometry
{
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v)
{
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

inline Eigen::Matrix3d rotationFromVector(const Eigen::Vector3d& r)
{
  const double angle = r.norm();
  if (angle < 1e-12)
    return Eigen::Matrix3d::Identity() + crossMatrix(r);
  return Eigen::AngleAxisd(angle, r / angle).toRotationMatrix();
}

inline Eigen::Vector3d vectorFromRotation(const Eigen::Matrix3d& R)
{
  const Eigen::AngleAxisd angle_axis(R);
  return angle_axis.angle() * angle_axis.axis();
}

/// Left Jacobian of SO(3): R(r + d) = R(J d) R(r) to first order (Barfoot, State Estimation for Robotics, Eq. 7.77).
inline Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& r)
{
  const double angle = r.norm();
  const Eigen::Matrix3d cross = crossMatrix(r);
  if (angle < 1e-6)
    return Eigen::Matrix3d::Identity() + 0.5 * cross;
  const double squared = angle * angle;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / squared * cross +
         (angle - std::sin(angle)) / (squared * angle) * cross * cross;
}

}  // namespace object_modelling::geometry
