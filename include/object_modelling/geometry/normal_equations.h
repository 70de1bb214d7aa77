#pragma once

#include <cmath>

#include <Eigen/Core>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::geometry
{
/// Weighted normal equations A xi = b of a least-squares pose; xi is a small motion on the left of T_camera_session.
struct NormalEquations
{
  geometry::Matrix6d A = geometry::Matrix6d::Zero();
  geometry::Vector6d b = geometry::Vector6d::Zero();

  void add(const Eigen::Matrix<double, 1, 6>& jacobian, double residual, double weight)
  {
    A.noalias() += weight * jacobian.transpose() * jacobian;
    b.noalias() -= weight * residual * jacobian.transpose();
  }
  NormalEquations& operator+=(const NormalEquations& other)
  {
    A += other.A;
    b += other.b;
    return *this;
  }
};

/// Weight of iteratively re-weighted least squares for Huber's loss (95 % efficient for normal errors).
inline double huberWeight(double residual_sigmas)
{
  constexpr double HUBER_SIGMAS = 1.345;
  const double size = std::abs(residual_sigmas);
  return size <= HUBER_SIGMAS ? 1.0 : HUBER_SIGMAS / size;
}

}  // namespace object_modelling::geometry
