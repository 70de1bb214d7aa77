#include "object_modelling/base/statistics.h"

#include <gtest/gtest.h>

namespace object_modelling::base
{
TEST(Median, IsTheMiddleWhateverTheOrder)
{
  std::vector<double> odd = { 5, 1, 3 }, even = { 4, 1, 2, 9 }, one = { 7 }, none;
  EXPECT_EQ(median(&odd), 3);
  EXPECT_EQ(median(&even), 4);
  EXPECT_EQ(median(&one), 7);
  EXPECT_EQ(median(&none), 0);
}

TEST(Quantile, IsTheLowerValueAtItsPlace)
{
  const std::vector<float> values = { 30, 10, 50, 20, 40 };
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 0.49), 20);
  EXPECT_EQ(quantile(values, 0.5), 30);
  EXPECT_EQ(quantile(values, 0.99), 40);
  EXPECT_EQ(quantile(values, 1), 50);
  EXPECT_EQ(quantile(std::vector<double>{}, 0.5), 0);
}

TEST(RobustDeviation, IsNotMovedByAnOutlier)
{
  EXPECT_NEAR(robustDeviation<double>({ -1, 1, -1, 1, 0, 1000, -1000 }), 1.4826, 1e-9);
  EXPECT_EQ(robustDeviation<float>({}), 0);
  EXPECT_EQ(robustDeviation<float>({ 4, 4, 4 }), 0);
}
}  // namespace object_modelling::base
