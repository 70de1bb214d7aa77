#pragma once

#include <Eigen/Core>

namespace object_modelling::registration
{
/// By how much another light changes the colours of a surface. Light comes from elsewhere once the object has been
/// turned over, and what the table reflects with it: what both make of a surface is, to first order, a difference of
/// brightness and hue that is linear in the normal (Lambert). Fitted by least squares, as large as light is likely to
/// make it: texture that is dark on one side is no light.
class LightDifference
{
public:
  /// Adds a point: how its colours differ, and its normal, always in the same frame.
  void add(const Eigen::Vector3f& difference, const Eigen::Vector3f& normal);

  /// Estimates the difference from the points added so far; before the first call it is none.
  void solve();

  Eigen::Vector3f at(const Eigen::Vector3f& normal) const;

  /// How much of the variance of the differences is light's, given what it is with and without this light taken off.
  /// Any differences of texture are linear in the normal by some share; that is taken off (adjusted R squared, Theil
  /// 1961).
  static double explained(double variance, double variance_left);

private:
  Eigen::Matrix4d A_ = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> B_ = Eigen::Matrix<double, 4, 3>::Zero();
  Eigen::Array3d squares_ = Eigen::Array3d::Zero();
  Eigen::Matrix<float, 4, 3> light_ = Eigen::Matrix<float, 4, 3>::Zero();  ///< by (normal, 1): a column per channel
};

}  // namespace object_modelling::registration
