#pragma once

#include "icp_matches.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::multi_view_icp
{
struct IcpLoss
{
  double width_sigmas = 2.385;  ///< Cauchy
  double color_weight = 1;
  int color_level = 0;
};

/// Of one directed pair, for a motion xi = (t, r) on the left of T_a_b: half the robust squared error is about
/// cost + g xi + xi A xi / 2.
struct IcpEquations
{
  double cost = 0;
  geometry::Matrix6d A = geometry::Matrix6d::Zero();
  geometry::Vector6d g = geometry::Vector6d::Zero();
};

double icpCost(const IcpView& a, const IcpMatches& matches, const Eigen::Isometry3d& T_a_b, const IcpLoss& loss);
IcpEquations icpEquations(const IcpView& a, const IcpMatches& matches, const Eigen::Isometry3d& T_a_b,
                          const IcpLoss& loss);

/// What the errors of normals and gradients alone bring into A: they let a surface slide along itself, and yet count as
/// knowledge of where it is.
geometry::Matrix6d icpNoise(const IcpView& a, const IcpMatches& matches, const Eigen::Isometry3d& T_a_b,
                            const IcpLoss& loss);

/// Point-to-plane errors of a pair, each as weighed in the estimate.
struct IcpError
{
  double squared_m2 = 0;  ///< weighed sum
  double weight = 0;      ///< in [0, 1] per point
  double squared_sigmas = 0;
  int count = 0;
  double rmse_m() const;
  void add(const IcpError& other);
};
/// `T_a_b`: where the errors are taken; `T_a_b_weights`: where the weights are.
IcpError icpError(const IcpMatches& matches, const Eigen::Isometry3d& T_a_b, const Eigen::Isometry3d& T_a_b_weights,
                  const IcpLoss& loss);

}  // namespace object_modelling::multi_view_icp
