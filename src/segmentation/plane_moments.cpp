#include "plane_moments.h"

#include <Eigen/Eigenvalues>

namespace object_modelling::segmentation
{
void PlaneMoments::add(const PlaneMoments& other)
{
  count += other.count;
  weight += other.weight;
  sum += other.sum;
  sum_of_squares += other.sum_of_squares;
}

PlaneMoments PlaneMoments::transformed(const Eigen::Isometry3d& T_a_b) const
{
  const Eigen::Matrix3d R = T_a_b.linear();
  const Eigen::Vector3d t = T_a_b.translation();
  const Eigen::Vector3d rotated = R * sum;
  PlaneMoments result = *this;
  result.sum = rotated + weight * t;
  result.sum_of_squares = R * sum_of_squares * R.transpose() + rotated * t.transpose() + t * rotated.transpose() +
                          weight * t * t.transpose();
  return result;
}

bool PlaneMoments::fit(const Eigen::Vector3d& viewpoint, geometry::Plane* plane) const
{
  if (count < 3 || !(weight > 0))
    return false;
  const Eigen::Vector3d center = mean();
  const Eigen::Matrix3d covariance = sum_of_squares / weight - center * center.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d& spread = solver.eigenvalues();
  if (!spread.allFinite() || spread(1) <= 1e-6 * spread(2))
    return false;
  plane->normal = solver.eigenvectors().col(0).normalized();
  plane->offset_m = -plane->normal.dot(center);
  if (plane->signedDistance_m(viewpoint) < 0)
  {
    plane->normal = -plane->normal;
    plane->offset_m = -plane->offset_m;
  }
  return true;
}

double PlaneMoments::meanSquare(const geometry::Plane& plane) const
{
  if (count == 0)
    return 0;
  const Eigen::Vector3d& n = plane.normal;
  const double d = plane.offset_m;
  return (n.dot(sum_of_squares * n) + 2 * d * n.dot(sum) + d * d * weight) / count;
}

}  // namespace object_modelling::segmentation
