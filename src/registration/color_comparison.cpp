#include "color_comparison.h"

#include <algorithm>
#include <cmath>

#include "light_difference.h"

namespace object_modelling::registration
{
void ColorComparison::add(const Eigen::Vector3f& of_a, const Eigen::Vector3f& of_b, const Eigen::Vector3f& normal)
{
  samples_.push_back({ of_a, of_b, normal });
}

ColorComparison::Result ColorComparison::result() const
{
  if (samples_.empty())
    return {};
  LightDifference light;
  for (const Sample& sample : samples_)
    light.add(sample.b - sample.a, sample.normal);
  light.solve();
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero(), left = Eigen::Vector3d::Zero();
  double aa = 0, bb = 0, ab = 0, squares_left = 0;
  for (const Sample& sample : samples_)
  {
    const Eigen::Vector3d x = sample.a.cast<double>(), y = sample.b.cast<double>();
    a += x;
    b += y;
    aa += x.squaredNorm();
    bb += y.squaredNorm();
    ab += x.dot(y);
    const Eigen::Vector3d difference = y - x - light.at(sample.normal).cast<double>();
    left += difference;
    squares_left += difference.squaredNorm();
  }
  // Exposure and white balance move the means; what is left must agree.
  const auto count = static_cast<double>(samples_.size());
  const double variance_a = std::max(0.0, aa / count - (a / count).squaredNorm());
  const double variance_b = std::max(0.0, bb / count - (b / count).squaredNorm());
  const double covariance = ab / count - (a / count).dot(b / count);
  const double variance_left = std::max(0.0, squares_left / count - (left / count).squaredNorm());
  Result result;
  result.texture = std::sqrt(std::sqrt(variance_a * variance_b));
  result.agreement = result.texture > 1e-6 ? covariance / (result.texture * result.texture) : 0;
  result.light_variance = LightDifference::explained((variance_a + variance_b) / 2 - covariance, variance_left / 2);
  return result;
}

}  // namespace object_modelling::registration
