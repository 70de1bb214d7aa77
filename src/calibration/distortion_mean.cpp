#include "object_modelling/calibration/distortion_mean.h"

#include <cmath>

namespace object_modelling::calibration
{
namespace
{
using Grid = rgbd::DistortionGrid;
constexpr double MAX_DISAGREEMENT = 0.71;  ///< of the size: half of its variance

double weightOf(const DistortionEstimate& estimate, int knot)
{
  const double sigma = estimate.sigma_ratio[knot];
  return std::isfinite(sigma) && sigma > 0 ? 1 / (sigma * sigma) : 0;
}

class WeightedSum
{
public:
  void add(double value, double weight)
  {
    sum_ += weight * value;
    weight_ += weight;
  }
  double mean() const { return weight_ > 0 ? sum_ / weight_ : 0; }

private:
  double sum_ = 0, weight_ = 0;
};
}  // namespace

DistortionMean meanDistortion(const std::vector<DistortionEstimate>& estimates)
{
  DistortionMean mean;
  WeightedSum size, disagreement, everywhere;
  for (int knot = 0; knot < Grid::KNOTS; ++knot)
  {
    WeightedSum all;
    for (std::size_t i = 0; i < estimates.size(); ++i)
    {
      const double ratio = estimates[i].ratio[knot], weight = weightOf(estimates[i], knot);
      all.add(ratio, weight);
      size.add(ratio * ratio, weight);
      everywhere.add(ratio, weight);
      WeightedSum others;
      for (std::size_t j = 0; j < estimates.size(); ++j)
        if (j != i)
          others.add(estimates[j].ratio[knot], weightOf(estimates[j], knot));
      if (estimates.size() > 1)
        disagreement.add(std::pow(ratio - others.mean(), 2), weight);
    }
    mean.ratio[knot] = all.mean();
  }
  for (double& ratio : mean.ratio)
    ratio -= everywhere.mean();
  mean.size_ratio = std::sqrt(size.mean());
  mean.disagreement_ratio = std::sqrt(disagreement.mean());
  mean.agrees = estimates.size() > 1 && mean.disagreement_ratio < MAX_DISAGREEMENT * mean.size_ratio;
  return mean;
}

}  // namespace object_modelling::calibration
