#include "object_modelling/rgbd/depth_units.h"

#include <gtest/gtest.h>

#include <limits>

#include "object_modelling/base/status.h"

namespace object_modelling::rgbd
{
namespace
{
const float NAN_F = std::numeric_limits<float>::quiet_NaN();
const float INF_F = std::numeric_limits<float>::infinity();

TEST(DepthUnits, MillimetersAndOtherUnits)
{
  const cv::Mat depth = (cv::Mat_<std::uint16_t>(1, 4) << 0, 1, 1000, 65535);
  const cv::Mat in_mm = depthInMeters(depth, 0.001);
  ASSERT_EQ(in_mm.type(), CV_32FC1);
  EXPECT_TRUE(std::isnan(in_mm.at<float>(0)));
  EXPECT_FLOAT_EQ(in_mm.at<float>(1), 0.001f);
  EXPECT_FLOAT_EQ(in_mm.at<float>(2), 1.0f);
  EXPECT_FLOAT_EQ(in_mm.at<float>(3), 65.535f);
  EXPECT_FLOAT_EQ(depthInMeters(depth, 0.0002).at<float>(2), 0.2f);
}

TEST(DepthUnits, FloatDepthIsCleaned)
{
  const cv::Mat depth = (cv::Mat_<float>(1, 6) << 1.5f, 0.0f, -1.0f, NAN_F, INF_F, -INF_F);
  const cv::Mat meters = depthInMeters(depth, 0.001);
  EXPECT_FLOAT_EQ(meters.at<float>(0), 1.5f);
  for (int i = 1; i < 6; ++i)
    EXPECT_TRUE(std::isnan(meters.at<float>(i))) << i;
  EXPECT_FLOAT_EQ(depth.at<float>(1), 0.0f);  // input untouched
}

TEST(DepthUnits, RoundTripOf16Bit)
{
  cv::Mat depth(40, 50, CV_16UC1);
  cv::RNG(3).fill(depth, cv::RNG::UNIFORM, 0, 65536);
  for (const double unit_m : { 0.001, 0.0002, 0.0001 })
    EXPECT_EQ(cv::norm(depthAs16Bit(depthInMeters(depth, unit_m), unit_m), depth, cv::NORM_INF), 0) << unit_m;
}

TEST(DepthUnits, As16BitRoundsAndDropsWhatDoesNotFit)
{
  const cv::Mat meters = (cv::Mat_<float>(1, 7) << 0.0004f, 0.0006f, 1.0004f, 65.5f, 66.0f, NAN_F, -1.0f);
  const cv::Mat depth = depthAs16Bit(meters, 0.001);
  ASSERT_EQ(depth.type(), CV_16UC1);
  const std::uint16_t expected[] = { 0, 1, 1000, 65500, 0, 0, 0 };
  for (int i = 0; i < 7; ++i)
    EXPECT_EQ(depth.at<std::uint16_t>(i), expected[i]) << i;
}

TEST(DepthUnits, PartOfALargerImage)
{
  cv::Mat depth(20, 20, CV_16UC1, cv::Scalar(7));
  depth(cv::Rect(5, 5, 4, 4)) = 2000;
  const cv::Mat meters = depthInMeters(depth(cv::Rect(5, 5, 4, 4)), 0.001);
  EXPECT_EQ(cv::countNonZero(meters == 2.0f), 16);
}

TEST(DepthUnits, RefusesOtherTypesAndUnits)
{
  for (const int type : { CV_8UC1, CV_8UC3, CV_64FC1, CV_16SC1, CV_32FC2 })
    EXPECT_THROW(depthInMeters(cv::Mat(2, 2, type), 0.001), base::Error) << type;
  EXPECT_THROW(depthAs16Bit(cv::Mat(2, 2, CV_64FC1), 0.001), base::Error);
  const cv::Mat depth = cv::Mat::ones(2, 2, CV_16UC1);
  for (const double unit_m : { 0.0, -1.0, static_cast<double>(NAN_F), static_cast<double>(INF_F) })
    EXPECT_THROW(depthInMeters(depth, unit_m), base::Error) << unit_m;
}

}  // namespace
}  // namespace object_modelling::rgbd
