#pragma once

#include <Eigen/Geometry>

namespace object_modelling::geometry
{
using Vector6d = Eigen::Matrix<double, 6, 1>;
/// Covariance of a pose, in the order of ROS: x, y, z (m), rotation about x, y, z (rad), both as a small motion applied
/// on the left (in the target frame): T = exp(xi) * T_mean.
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Rotation by the angle |rotation_rad| about its direction, and translation: (t, r) -> [R(r) | t]. Not the SE(3)
/// exponential: translation and rotation stay uncoupled, which is what the small updates of our optimisers mean.
Eigen::Isometry3d isometryFromVector(const Vector6d& translation_m_rotation_rad);
Vector6d vectorFromIsometry(const Eigen::Isometry3d& T);

Eigen::Isometry3d isometryFrom(const Eigen::Quaterniond& R, const Eigen::Vector3d& t);

/// A small motion applied on the left of T_b_x, seen as one on the left of T_a_x: xi_a = adjoint(T_a_b) xi_b. Its
/// covariance goes along: C_a = adjoint C_b adjoint^T.
Matrix6d adjoint(const Eigen::Isometry3d& T_a_b);

/// Angle of a rotation in [0, pi].
double rotationAngle_rad(const Eigen::Isometry3d& T);

/// Smallest rotation that takes the direction `from` to the direction `to`; neither is zero.
Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
Eigen::Matrix3f rotationBetween(const Eigen::Vector3f& from, const Eigen::Vector3f& to);

/// Re-orthonormalised copy, for products of many transforms.
Eigen::Isometry3d normalized(const Eigen::Isometry3d& T);

/// Least-squares rigid transform T_a_b with p_a = T_a_b p_b (Umeyama 1991, without scale). Needs n >= 3 columns that
/// are not collinear; returns false for fewer or degenerate ones.
bool rigidTransformFromPoints(const Eigen::Matrix3Xd& p_a, const Eigen::Matrix3Xd& p_b, Eigen::Isometry3d* T_a_b);

}  // namespace object_modelling::geometry
