#include "light_difference.h"

#include <algorithm>

#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::registration
{
namespace
{
constexpr double LIGHT_SIGMA = 0.15;  // of what another light makes of brightness and hue
constexpr double PATCHES = 30;        // of a surface whose texture errs on its own
constexpr double SLOPES = 3;

template <typename Scalar>
Eigen::Matrix<Scalar, 4, 1> basis(const Eigen::Vector3f& normal)
{
  return normal.homogeneous().cast<Scalar>();
}
}  // namespace

void LightDifference::add(const Eigen::Vector3f& difference, const Eigen::Vector3f& normal)
{
  const Eigen::Vector4d x = basis<double>(normal);
  const Eigen::Vector3d y = difference.cast<double>();
  A_ += x * x.transpose();
  B_ += x * y.transpose();
  squares_ += y.array().square();
}

void LightDifference::solve()
{
  const double count = A_(3, 3);
  if (count < 1)
    return;
  const Eigen::Array3d variance = (squares_ / count - (B_.row(3).transpose().array() / count).square()).max(0);
  for (int channel = 0; channel < 3; ++channel)
  {
    // Differences of texture are noise here, and as many of them as there are patches.
    Eigen::Matrix4d damped = A_ + 1e-6 * Eigen::Matrix4d::Identity();
    damped.diagonal().head<3>().array() += count / PATCHES * variance[channel] / (LIGHT_SIGMA * LIGHT_SIGMA);
    light_.col(channel) = geometry::solveSymmetric(damped, Eigen::Vector4d(B_.col(channel))).cast<float>();
  }
}

Eigen::Vector3f LightDifference::at(const Eigen::Vector3f& normal) const
{
  return light_.transpose() * basis<float>(normal);
}

double LightDifference::explained(double variance, double variance_left)
{
  constexpr double CHANCE = SLOPES / PATCHES;
  return std::max(0.0, (variance - variance_left - CHANCE * variance) / (1 - CHANCE));
}

}  // namespace object_modelling::registration
