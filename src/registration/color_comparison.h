#pragma once

#include <vector>

#include <Eigen/Core>

namespace object_modelling::registration
{
/// Compares the colours of two parts on their common surface, each under its own light.
class ColorComparison
{
public:
  /// Adds a point that both saw; `normal` in the frame of one of them, always the same.
  void add(const Eigen::Vector3f& of_a, const Eigen::Vector3f& of_b, const Eigen::Vector3f& normal);

  struct Result
  {
    double agreement = 0;       ///< [-1, 1] correlation; 0 without texture
    double texture = 0;         ///< geometric mean of the two standard deviations
    double light_variance = 0;  ///< how much of the mean of the two variances less the covariance is light's
  };
  Result result() const;

private:
  struct Sample
  {
    Eigen::Vector3f a, b, normal;
  };
  std::vector<Sample> samples_;
};

}  // namespace object_modelling::registration
