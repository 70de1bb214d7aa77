#include "object_modelling/base/ransac.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace object_modelling::base
{
namespace
{
struct Line
{
  double slope, offset;
};

/// Points (x, y), of which the first `inliers` lie on y = 2 x + 1 and no three others on any line.
class RansacOfLines : public testing::Test
{
protected:
  static std::vector<std::array<double, 2>> points(int count, int inliers)
  {
    std::vector<std::array<double, 2>> result;
    for (int i = 0; i < count; ++i)
      result.push_back({ 1.0 * i, i < inliers ? 2.0 * i + 1 : 1000.0 + i * i * i });
    return result;
  }

  std::optional<Hypothesis<Line>> estimate(const std::vector<std::array<double, 2>>& points,
                                           std::optional<Hypothesis<Line>> start = std::nullopt)
  {
    solved_ = 0;
    const auto solve = [&](const std::array<int, 2>& sample) -> std::optional<Line>
    {
      ++solved_;
      const auto& [x, y] = points[sample[0]];
      const double slope = (points[sample[1]][1] - y) / (points[sample[1]][0] - x);
      return Line{ slope, y - slope * x };
    };
    const auto inlier_ratio = [&](const Line& line)
    {
      int inliers = 0;
      for (const auto& [x, y] : points)
        inliers += std::abs(line.slope * x + line.offset - y) < 1e-6;
      return inliers > 2 ? inliers / static_cast<double>(points.size()) : 0;
    };
    return ransac<2, Line>(points.size(), options_, solve, inlier_ratio, start);
  }

  RansacOptions options_;
  int solved_ = 0;
};
}  // namespace

TEST(SamplesNeeded, AreThoseOfTheTextbook)
{
  EXPECT_NEAR(samplesNeeded(0.5, 3, 0.99), 34.5, 0.1);
  EXPECT_NEAR(samplesNeeded(0.5, 2, 0.99), 16.0, 0.1);
  EXPECT_NEAR(samplesNeeded(0.3, 3, 0.999), 252.4, 0.1);
  EXPECT_NEAR(samplesNeeded(0.01, 3, 0.99), 4.6e6, 1e5);
  EXPECT_LE(samplesNeeded(1, 3, 0.99), 1);
  EXPECT_GT(samplesNeeded(1, 3, 0.99), 0);
  EXPECT_EQ(samplesNeeded(0, 3, 0.99), std::numeric_limits<double>::infinity());
}

TEST(SampleDraws, AreOfDifferentThingsAndReachAll)
{
  for (const IndexDraw draw : { IndexDraw::REMAINDER, IndexDraw::LIBRARY_DISTRIBUTION })
  {
    SampleDraws<3> draws(4, 7, draw);
    std::set<std::set<int>> seen;
    for (int i = 0; i < 200; ++i)
      if (const auto sample = draws.next())
      {
        const std::set<int> indices(sample->begin(), sample->end());
        EXPECT_EQ(indices.size(), 3U);
        EXPECT_TRUE(*indices.begin() >= 0 && *indices.rbegin() < 4);
        seen.insert(indices);
      }
    EXPECT_EQ(seen.size(), 4U);
  }
}

TEST(SampleDraws, AreNoneOfTooFewThings)
{
  for (const std::size_t count : { 0, 1, 2 })
    EXPECT_FALSE(SampleDraws<3>(count, 1).next()) << count;
}

TEST(SampleDraws, AreTheSameOfTheSameSeed)
{
  SampleDraws<3> first(50, 3), second(50, 3), other(50, 4);
  int different = 0;
  for (int i = 0; i < 20; ++i)
  {
    const auto sample = first.next();
    EXPECT_EQ(sample, second.next());
    different += sample != other.next();
  }
  EXPECT_GT(different, 15);
}

TEST_F(RansacOfLines, FindsTheLineOfAThirdOfThePointsFromAnySeed)
{
  for (options_.seed = 1; options_.seed <= 20; ++options_.seed)
  {
    const auto found = estimate(points(60, 20));
    ASSERT_TRUE(found) << options_.seed;
    EXPECT_NEAR(found->model.slope, 2, 1e-9);
    EXPECT_NEAR(found->inlier_ratio, 1.0 / 3, 1e-12);
    EXPECT_LE(solved_, samplesNeeded(1.0 / 3, 2, 0.99) + 150) << "stops soon after it has found the line";
  }
}

TEST_F(RansacOfLines, StopsByItsConfidenceFactorAndLimit)
{
  estimate(points(60, 60));
  EXPECT_EQ(solved_, 1);
  options_.samples_factor = 3;
  options_.confidence_ratio = 0.999;
  estimate(points(60, 60));
  EXPECT_EQ(solved_, 3);
  options_.max_samples = 40;
  estimate(points(60, 0));
  EXPECT_LE(solved_, 40);
  EXPECT_GT(solved_, 30) << "few samples have a point twice";
}

TEST_F(RansacOfLines, IsTheSameOfTheSameSeed)
{
  options_.max_samples = 5;
  options_.seed = 11;
  const auto first = estimate(points(40, 35)), second = estimate(points(40, 35));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->model.slope, second->model.slope);
  EXPECT_EQ(first->inlier_ratio, second->inlier_ratio);
}

TEST_F(RansacOfLines, HasNothingToTellOfOutliersAloneOrTooFewPoints)
{
  EXPECT_FALSE(estimate(points(50, 0)));
  EXPECT_FALSE(estimate(points(1, 1)));
  EXPECT_FALSE(estimate({}));
  EXPECT_EQ(solved_, 0);
}

TEST_F(RansacOfLines, KeepsItsStartUnlessASampleIsBetter)
{
  const Hypothesis<Line> perfect{ { 2, 1 }, 1 }, poor{ { 0, 0 }, 0.05 };
  EXPECT_EQ(estimate(points(1, 1), poor)->model.slope, 0);
  EXPECT_EQ(estimate(points(50, 0), poor)->model.slope, 0);
  EXPECT_NEAR(estimate(points(50, 40), poor)->model.slope, 2, 1e-9);
  EXPECT_EQ(estimate(points(50, 50), perfect)->inlier_ratio, 1);
  EXPECT_LE(solved_, 1) << "one sample at most beside a start that all points agree with";
}
}  // namespace object_modelling::base
