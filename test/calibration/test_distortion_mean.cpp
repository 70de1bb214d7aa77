#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "object_modelling/calibration/distortion_mean.h"

namespace object_modelling::calibration
{
namespace
{
using Grid = rgbd::DistortionGrid;

Grid::Ratios random(double sigma, int seed)
{
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, sigma);
  Grid::Ratios ratios;
  for (double& ratio : ratios)
    ratio = normal(generator);
  return ratios;
}

DistortionEstimate estimate(const Grid::Ratios& truth, double sigma, int seed)
{
  DistortionEstimate result;
  const Grid::Ratios error = random(sigma, seed);
  for (int i = 0; i < Grid::KNOTS; ++i)
    result.ratio[i] = truth[i] + error[i];
  result.sigma_ratio.fill(sigma);
  return result;
}

TEST(DistortionMean, recordingsThatAgreeAreTaken)
{
  const Grid::Ratios truth = random(0.001, 1);
  const DistortionMean mean = meanDistortion({ estimate(truth, 2e-4, 2), estimate(truth, 2e-4, 3) });
  EXPECT_TRUE(mean.agrees);
  EXPECT_NEAR(mean.size_ratio, 0.001, 2e-4);
  EXPECT_NEAR(mean.disagreement_ratio, 2e-4 * std::sqrt(2.0), 1e-4);
  double error = 0;
  for (int i = 0; i < Grid::KNOTS; ++i)
    error += std::pow(mean.ratio[i] - truth[i], 2) / Grid::KNOTS;
  EXPECT_NEAR(std::sqrt(error), 2e-4 / std::sqrt(2.0), 5e-5);
}

TEST(DistortionMean, noiseIsNoDistortion)
{
  for (int seed = 0; seed < 20; ++seed)
  {
    std::vector<DistortionEstimate> estimates;
    for (int i = 0; i < 2 + seed % 3; ++i)
      estimates.push_back(estimate({}, 3e-4, 10 * seed + i));
    EXPECT_FALSE(meanDistortion(estimates).agrees) << seed;
  }
}

TEST(DistortionMean, oneRecordingAloneIsNotTaken)
{
  EXPECT_FALSE(meanDistortion({}).agrees);
  const DistortionMean mean = meanDistortion({ estimate(random(0.001, 1), 1e-5, 2) });
  EXPECT_FALSE(mean.agrees);
  EXPECT_GT(mean.size_ratio, 5e-4);
}

TEST(DistortionMean, theMoreCertainCountsMore)
{
  DistortionEstimate rough, exact, unknown;
  rough.ratio[7] = 0.003;
  rough.sigma_ratio.fill(2e-4);
  exact.ratio[7] = 0.001;
  exact.sigma_ratio.fill(1e-4);
  unknown.ratio.fill(1);
  unknown.sigma_ratio.fill(std::numeric_limits<double>::quiet_NaN());
  const DistortionMean mean = meanDistortion({ rough, exact, unknown });
  EXPECT_NEAR(mean.ratio[7], 0.0014 * (Grid::KNOTS - 1) / Grid::KNOTS, 1e-9);
  EXPECT_NEAR(mean.ratio[8], -0.0014 / Grid::KNOTS, 1e-9);
  EXPECT_EQ(meanDistortion({ unknown }).ratio[7], 0);
  exact.ratio.fill(0.001);
  EXPECT_NEAR(meanDistortion({ exact, exact }).ratio[7], 0, 1e-12);  // that is the scale
}
}  // namespace
}  // namespace object_modelling::calibration
