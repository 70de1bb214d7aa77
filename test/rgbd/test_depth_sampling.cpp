#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "object_modelling/rgbd/depth_sampling.h"

namespace object_modelling::rgbd
{
TEST(DepthSampling, InterpolatesOneSurfaceOnly)
{
  cv::Mat depth_m = (cv::Mat_<float>(3, 4) << 1.000F, 1.004F, 1.008F, 1.5F, 1.002F, 1.006F, 1.010F, 1.5F, 1.0F,
                     std::numeric_limits<float>::quiet_NaN(), 1.0F, 1.0F);
  EXPECT_NEAR(sampleDepth_m(depth_m, 0.25F, 0.5F), 1.002F, 1e-6);
  EXPECT_TRUE(std::isnan(sampleDepth_m(depth_m, 2.5F, 0.5F)));  // across a step
  EXPECT_TRUE(std::isnan(sampleDepth_m(depth_m, 0.5F, 1.5F)));  // next to a hole
  EXPECT_TRUE(std::isnan(sampleDepth_m(depth_m, -0.1F, 0.5F)));
  EXPECT_TRUE(std::isnan(sampleDepth_m(depth_m, 3.2F, 0.5F)));
  EXPECT_TRUE(std::isnan(sampleDepth_m(depth_m, std::numeric_limits<float>::quiet_NaN(), 0.5F)));
}

TEST(DepthSampling, AllowsStepsUpToARatioOfTheNearest)
{
  const cv::Mat depth_m = (cv::Mat_<float>(2, 2) << 1.0F, 1.04F, 1.0F, 1.04F);
  EXPECT_NEAR(sampleDepth_m(depth_m, 0.5F, 0.5F, 0.05F), 1.02F, 1e-6);
  EXPECT_TRUE(std::isnan(sampleDepth_m(depth_m, 0.5F, 0.5F, 0.03F)));
  const DepthBetween depth = depthBetween(depth_m, { 0.25F, 0.5F });
  EXPECT_NEAR(depth.z_m, 1.01F, 1e-6);
  EXPECT_EQ(depth.nearest_m, 1.0F);
  EXPECT_NEAR(depth.step_m, 0.04F, 1e-6);
}
}  // namespace object_modelling::rgbd
