#pragma once

#include <optional>
#include <vector>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::multi_view_icp
{
/// Information beyond that many times the noise's counts.
constexpr double NOISE_FACTOR = 2;

/// Half the squared error of what ties views a and b together is about cost + g d + d A d / 2, where d is a's
/// motion minus b's, both on the left of T_world_camera. Moving both alike changes nothing, so the relative motion
/// suffices.
struct PairEquations
{
  int a = -1, b = -1;
  double cost = 0;
  geometry::Matrix6d A = geometry::Matrix6d::Zero();
  geometry::Vector6d g = geometry::Vector6d::Zero();
};

/// Least motions of all views, with Levenberg and Marquardt's damping; those of one body move alike. The body of
/// the first of `members` stays where it is, as do views that are not members. Nothing if there is nothing to
/// move, or the equations have no solution.
std::optional<std::vector<geometry::Vector6d>> solveMotions(const std::vector<PairEquations>& pairs,
                                                            const std::vector<int>& members,
                                                            const std::vector<int>& bodies, double damping);

/// The same, along those motions alone that the pairs resist by more than noise does, given what noise alone brings
/// into A of each pair. A surface that slides along itself is held by nothing but the errors of its normals: each
/// iteration would move it a little, with the next noise, for ever.
std::optional<std::vector<geometry::Vector6d>> solveResisted(const std::vector<PairEquations>& pairs,
                                                             const std::vector<geometry::Matrix6d>& noise,
                                                             const std::vector<int>& members,
                                                             const std::vector<int>& bodies, double damping);

/// Covariance of those motions: blocks of the inverse, for members of bodies but the first's; zero for the others, and
/// for all if the equations are singular. `prior`: information of each motion besides the pairs'.
std::vector<geometry::Matrix6d> motionCovariances(const std::vector<PairEquations>& pairs,
                                                  const std::vector<int>& members, const std::vector<int>& bodies,
                                                  const geometry::Matrix6d& prior);

}  // namespace object_modelling::multi_view_icp
