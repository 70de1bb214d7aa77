#pragma once

#include <Eigen/Geometry>

#include "object_modelling/geometry/plane.h"

namespace object_modelling::segmentation
{
/// Weighted first and second moments of points: a plane can be fitted to them at any time, and they add up. With
/// weights 1 / sigma^2 the residuals are in sigmas.
struct PlaneMoments
{
  int count = 0;
  double weight = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d sum_of_squares = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& p, double w)
  {
    ++count;
    weight += w;
    const Eigen::Vector3d wp = w * p;
    sum += wp;
    sum_of_squares.noalias() += wp * p.transpose();
  }
  void add(const PlaneMoments& other);
  /// The moments of the same points in frame a, given those in frame b.
  PlaneMoments transformed(const Eigen::Isometry3d& T_a_b) const;

  Eigen::Vector3d mean() const { return sum / weight; }

  /// Total-least-squares plane, normal to the side of `viewpoint`; false for fewer than 3 points or collinear ones.
  bool fit(const Eigen::Vector3d& viewpoint, geometry::Plane* plane) const;
  /// Weighted mean of the squared distances to the plane, per point: 1 for residuals of one sigma.
  double meanSquare(const geometry::Plane& plane) const;
};

}  // namespace object_modelling::segmentation
