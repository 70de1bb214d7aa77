#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "object_modelling/geometry/image_sampling.h"

namespace object_modelling::geometry
{
namespace
{
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
}

TEST(ImageSampling, NeighborsAreNeededOnAllSides)
{
  const cv::Mat image(3, 4, CV_32FC1);
  EXPECT_TRUE(hasNeighbors(image, 0, 0));
  EXPECT_TRUE(hasNeighbors(image, 2.99F, 1.99F));
  EXPECT_FALSE(hasNeighbors(image, 3, 1));
  EXPECT_FALSE(hasNeighbors(image, 1, 2));
  EXPECT_FALSE(hasNeighbors(image, -0.01F, 1));
  EXPECT_FALSE(hasNeighbors(image, 1, -0.01F));
  EXPECT_FALSE(hasNeighbors(image, NOT_A_NUMBER, 1));
  EXPECT_FALSE(hasNeighbors(image, 1, NOT_A_NUMBER));
}

TEST(ImageSampling, IsLinearAlongBothAxes)
{
  const float upper[] = { 10, 20 }, lower[] = { 30, 80 };
  EXPECT_EQ(bilinear(upper, lower, SubPixel(7, 5)), 10);
  EXPECT_FLOAT_EQ(bilinear(upper, lower, SubPixel(7.25F, 5)), 12.5F);
  EXPECT_FLOAT_EQ(bilinear(upper, lower, SubPixel(7, 5.5F)), 20);
  EXPECT_FLOAT_EQ(bilinear(upper, lower, SubPixel(7.5F, 5.5F)), 35);
}

TEST(ImageSampling, ColorsOutsideAreThoseOfTheRim)
{
  cv::Mat image(2, 3, CV_8UC3);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image.at<cv::Vec3b>(v, u) = cv::Vec3b(static_cast<uchar>(10 * u), static_cast<uchar>(20 * v), 7);
  cv::Mat as_float;
  image.convertTo(as_float, CV_32FC3);
  for (const cv::Mat& given : { image, as_float })
  {
    EXPECT_TRUE(colorAt(given, { 1.5F, 0.25F }).isApprox(Eigen::Vector3f(15, 5, 7)));
    EXPECT_TRUE(colorAt(given, { 2, 1 }).isApprox(Eigen::Vector3f(20, 20, 7)));
    EXPECT_TRUE(colorAt(given, { 9, 9 }).isApprox(Eigen::Vector3f(20, 20, 7)));
    EXPECT_TRUE(colorAt(given, { -3, 0.5F }).isApprox(Eigen::Vector3f(0, 10, 7)));
  }
}

TEST(ImageSampling, GrayLevelsHaveTheSlopesOfTheirSurface)
{
  cv::Mat gray(4, 5, CV_8UC1);
  for (int v = 0; v < gray.rows; ++v)
    for (int u = 0; u < gray.cols; ++u)
      gray.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(100 + 12 * u - 9 * v);
  float value = 0;
  Eigen::Vector2f gradient;
  ASSERT_TRUE(sampleGray(gray, 2.25F, 1.5F, &value, &gradient));
  EXPECT_FLOAT_EQ(value, 100 + 12 * 2.25F - 9 * 1.5F);
  EXPECT_TRUE(gradient.isApprox(Eigen::Vector2f(12, -9)));
  EXPECT_FALSE(sampleGray(gray, 4, 1, &value, &gradient));
  EXPECT_FALSE(sampleGray(gray, 1, NOT_A_NUMBER, &value, &gradient));
}
}  // namespace object_modelling::geometry
