#include "object_modelling/features/relative_pose.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "support/synthetic_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::features
{
namespace
{
constexpr double DEGREE_RAD = M_PI / 180, MM_M = 1e-3;

class RelativePoseOfPoints : public testing::Test
{
protected:
  RelativePoseOfPoints()
  {
    frame_.camera = test_support::vgaCamera();
    T_a_b_ = Eigen::Translation3d(0.2, -0.1, 0.15) * Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, -1).normalized());
  }

  /// Points about 0.8 m from both cameras, with this share of the noise that their covariances tell; the first
  /// `outliers` of them are somewhere else.
  std::vector<PointPair> pairs(int count, double noise, int outliers, unsigned seed) const
  {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> within(-0.2, 0.2);
    const auto anywhere = [&] { return Eigen::Vector3d{ within(random), within(random), 0.8 + within(random) }; };
    const auto noisy = [&](const Eigen::Vector3d& p)
    {
      const Eigen::Matrix3d L = backProjectionCovariance(p, frame_, 0.5).llt().matrixL();
      return Eigen::Vector3d(p + noise * L * Eigen::Vector3d{ normal(random), normal(random), normal(random) });
    };
    std::vector<PointPair> result;
    for (int i = 0; i < count; ++i)
    {
      const Eigen::Vector3d p_a = anywhere();
      PointPair pair;
      pair.p_a = noisy(p_a);
      pair.p_b = noisy(i < outliers ? anywhere() : T_a_b_.inverse() * p_a);
      pair.sigma_a_px = pair.sigma_b_px = 0.5;
      result.push_back(pair);
    }
    return result;
  }
  RelativePose estimate(const std::vector<PointPair>& pairs, std::uint64_t seed = 1) const
  {
    RelativePoseOptions options;
    options.seed = seed;
    return estimateRelativePose(pairs, frame_, frame_, options);
  }
  static std::vector<PointPair> swapped(std::vector<PointPair> pairs)
  {
    for (PointPair& pair : pairs)
      std::swap(pair.p_a, pair.p_b);
    return pairs;
  }

  rgbd::Frame frame_;
  Eigen::Isometry3d T_a_b_;
};

TEST_F(RelativePoseOfPoints, IsExactWithoutNoiseEitherWay)
{
  for (const int count : { 4, 50 })
  {
    const RelativePose found = estimate(pairs(count, 0, 0, 1)), back = estimate(swapped(pairs(count, 0, 0, 1)));
    ASSERT_TRUE(found.found && back.found) << count;
    EXPECT_TRANSFORM_NEAR(found.T_a_b, T_a_b_, 1e-9, 1e-7);
    EXPECT_TRANSFORM_NEAR(back.T_a_b, T_a_b_.inverse(), 1e-9, 1e-7);
    std::vector<int> all(static_cast<std::size_t>(count));
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(found.inliers, all);
  }
}

TEST_F(RelativePoseOfPoints, IsFoundAmongOutliersFromAnySeed)
{
  constexpr int COUNT = 100, OUTLIERS = 60;
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    const std::vector<PointPair> given = pairs(COUNT, 1, OUTLIERS, seed);
    const RelativePose found = estimate(given, seed), back = estimate(swapped(given), seed);
    ASSERT_TRUE(found.found && back.found) << seed;
    // Of 40 points with 1.5 mm of noise, 0.8 m away.
    EXPECT_TRANSFORM_NEAR(found.T_a_b, T_a_b_, 4 * MM_M, 0.3 * DEGREE_RAD) << seed;
    EXPECT_TRANSFORM_NEAR(back.T_a_b, found.T_a_b.inverse(), 0.5 * MM_M, 0.05 * DEGREE_RAD) << seed;
    int right = 0, wrong = 0;
    for (const int i : found.inliers)
      ++(i < OUTLIERS ? wrong : right);
    EXPECT_GE(right, 38) << seed;
    EXPECT_LE(wrong, 1) << seed;
    EXPECT_TRUE(std::is_sorted(found.inliers.begin(), found.inliers.end()));
  }
}

TEST_F(RelativePoseOfPoints, SameSeedSameBytes)
{
  const std::vector<PointPair> given = pairs(60, 1, 30, 4);
  const RelativePose first = estimate(given, 9), second = estimate(given, 9);
  EXPECT_EQ(first.T_a_b.matrix(), second.T_a_b.matrix());
  EXPECT_EQ(first.inliers, second.inliers);
}

TEST_F(RelativePoseOfPoints, IsNotFoundWherePointsDoNotTell)
{
  EXPECT_FALSE(estimate({}).found);
  EXPECT_FALSE(estimate(pairs(3, 0, 0, 1)).found) << "three agree always";
  std::vector<PointPair> line = pairs(30, 0, 0, 1), one = line;
  for (std::size_t i = 0; i < line.size(); ++i)
  {
    line[i].p_a = Eigen::Vector3d(0.01 * static_cast<double>(i), 0, 0.8);
    line[i].p_b = T_a_b_.inverse() * line[i].p_a;
    one[i] = one[0];
  }
  EXPECT_FALSE(estimate(line).found) << "about the line it may turn";
  EXPECT_FALSE(estimate(one).found);
  EXPECT_LT(estimate(pairs(60, 1, 60, 2)).inliers.size(), 10u) << "chance alone";
}

TEST_F(RelativePoseOfPoints, WithinTheGateArePairsThatTheNoiseExplains)
{
  // On the axis, lateral sigma 1 m * 0.5 / 525 and axial sigma that of the sensor; of both ends together.
  const double lateral_m = std::sqrt(2.0) * 0.5 / 525;
  const double axial_m = std::sqrt(2.0) * frame_.noise_model.axialSigma_m(1, 0);
  std::vector<PointPair> given(5);
  for (PointPair& pair : given)
  {
    pair.p_a = pair.p_b = Eigen::Vector3d::UnitZ();
    pair.sigma_a_px = pair.sigma_b_px = 0.5;
  }
  // Off by 2.9, 3.1, 2.9 and 3.1 sigmas; covariances stay nearly those of the axis.
  given[1].p_a.x() += 2.9 * lateral_m;
  given[2].p_a.x() += 3.1 * lateral_m;
  given[3].p_b.z() -= 2.9 * axial_m;
  given[4].p_b.z() -= 3.1 * axial_m;
  const Eigen::Isometry3d I = Eigen::Isometry3d::Identity();
  EXPECT_EQ(inliersOf(I, given, frame_, frame_, 3), (std::vector<int>{ 0, 1, 3 }));
  EXPECT_EQ(inliersOf(I, given, frame_, frame_, 3.3).size(), 5u);
  EXPECT_TRUE(inliersOf(I, {}, frame_, frame_, 3).empty());
}

TEST_F(RelativePoseOfPoints, CovarianceLiesAlongTheRayAndAcrossIt)
{
  for (const double z_m : { 0.5, 2.0 })
  {
    const double axial_m = frame_.noise_model.axialSigma_m(z_m, 0), lateral_m = z_m * 0.7 / 525;
    Eigen::Matrix3d on_axis = Eigen::Matrix3d::Zero();
    on_axis.diagonal() << lateral_m * lateral_m, lateral_m * lateral_m, axial_m * axial_m;
    EXPECT_TRUE(backProjectionCovariance({ 0, 0, z_m }, frame_, 0.7).isApprox(on_axis, 1e-9));
    // Beside the axis a depth that is off moves the point along its ray: by half as much in x as in z.
    const Eigen::Matrix3d aside = backProjectionCovariance({ z_m / 2, 0, z_m }, frame_, 0.7);
    EXPECT_NEAR(aside(2, 2), axial_m * axial_m, 1e-15);
    EXPECT_NEAR(aside(0, 2), axial_m * axial_m / 2, 1e-15);
    EXPECT_NEAR(aside(0, 0), axial_m * axial_m / 4 + lateral_m * lateral_m, 1e-15);
    EXPECT_NEAR(aside(1, 1), lateral_m * lateral_m, 1e-15);
  }
}

}  // namespace
}  // namespace object_modelling::features
