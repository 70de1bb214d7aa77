#include "object_modelling/features/described_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace object_modelling::features
{
namespace
{
/// Bright Gaussian blobs of known centres.
cv::Mat blobs(const std::vector<cv::Point2f>& centers, double sigma_px)
{
  cv::Mat gray(480, 640, CV_32FC1, cv::Scalar(40)), result;
  for (int v = 0; v < gray.rows; ++v)
    for (int u = 0; u < gray.cols; ++u)
      for (const cv::Point2f& center : centers)
        gray.at<float>(v, u) += static_cast<float>(
            180 * std::exp(-0.5 * (std::pow(u - center.x, 2) + std::pow(v - center.y, 2)) / (sigma_px * sigma_px)));
  gray.convertTo(result, CV_8U);
  return result;
}

cv::Mat rows(std::initializer_list<std::initializer_list<float>> values)
{
  cv::Mat result;
  for (const auto& row : values)
    result.push_back(cv::Mat(std::vector<float>(row)).reshape(1, 1));
  return result;
}

cv::Mat bytes(std::initializer_list<std::uint8_t> values)
{
  return cv::Mat(std::vector<std::uint8_t>(values)).reshape(1, static_cast<int>(values.size())).clone();
}
}  // namespace

TEST(DescribedPoints, ScaleInvariantOnesLieOnTheCentersOfBlobsOfAnySize)
{
  const std::vector<cv::Point2f> centers = { { 100, 90 }, { 333.3F, 250.7F }, { 500.5F, 120 }, { 200, 400.25F } };
  for (const double sigma_px : { 3.0, 6.0, 12.0 })
  {
    const DescribedPoints found = detectScaleInvariant(blobs(centers, sigma_px), {}, 200);
    ASSERT_EQ(found.descriptors.rows, static_cast<int>(found.pixels.size()));
    for (const cv::Point2f& center : centers)
    {
      cv::Point2f nearest(1e6F, 1e6F);
      for (const cv::Point2f& pixel : found.pixels)
        if (cv::norm(pixel - center) < cv::norm(nearest))
          nearest = pixel - center;
      EXPECT_LT(cv::norm(nearest), 0.1) << center << " of sigma " << sigma_px << " px is off by " << nearest;
    }
  }
}

TEST(DescribedPoints, KeepToTheMask)
{
  const cv::Mat gray = blobs({ { 100, 90 }, { 500, 300 } }, 6);
  cv::Mat mask(gray.size(), CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(50, 40, 100, 100)) = 255;
  for (const auto& detect : { detectScaleInvariant, detectQuick })
    for (const cv::Point2f& pixel : detect(gray, mask, 200).pixels)
      EXPECT_LT(pixel.x, 151);
  EXPECT_FALSE(detectScaleInvariant(gray, mask, 200).pixels.empty());
  EXPECT_TRUE(detectScaleInvariant(cv::Mat(100, 100, CV_8UC1, cv::Scalar(77)), {}, 200).pixels.empty());
}

TEST(MatchDescriptors, TakesMutualNearestThatAreDistinct)
{
  const cv::Mat a = rows({ { 0, 0 }, { 100, 0 }, { 0, 100 }, { 60, 60 } });
  const cv::Mat b = rows({ { 0, 98 }, { 2, 0 }, { 99, 2 }, { 58, 60 }, { 62, 60 } });
  const std::vector<DescriptorMatch> matches = matchDescriptors(a, b, cv::NORM_L2, 0.8);
  ASSERT_EQ(matches.size(), 3u) << "the last of a has two that are as near";
  EXPECT_EQ(matches[0].b, 1);
  EXPECT_EQ(matches[1].b, 2);
  EXPECT_EQ(matches[2].b, 0);
}

TEST(MatchDescriptors, RatioIsOfDistancesInEitherNorm)
{
  // The nearest at 7, the second at 10: 0.7.
  const cv::Mat a = rows({ { 0, 0 }, { 1000, 0 } }), b = rows({ { 7, 0 }, { -10, 0 } });
  EXPECT_EQ(matchDescriptors(a, b, cv::NORM_L2, 0.75).size(), 1u);
  EXPECT_EQ(matchDescriptors(a, b, cv::NORM_L2, 0.65).size(), 0u);
  // One and two bits.
  const cv::Mat c = bytes({ 0b0000, 0b11111111 }), d = bytes({ 0b0001, 0b0011 });
  EXPECT_EQ(matchDescriptors(c, d, cv::NORM_HAMMING, 0.6).size(), 1u);
  EXPECT_EQ(matchDescriptors(c, d, cv::NORM_HAMMING, 0.4).size(), 0u);
}

TEST(MatchDescriptors, NoneOfTooFew)
{
  const cv::Mat two = rows({ { 0, 0 }, { 9, 9 } }), one = rows({ { 0, 0 } });
  EXPECT_TRUE(matchDescriptors(two, one, cv::NORM_L2, 0.8).empty());
  EXPECT_TRUE(matchDescriptors(one, two, cv::NORM_L2, 0.8).empty());
  EXPECT_TRUE(matchDescriptors({}, {}, cv::NORM_L2, 0.8).empty());
}

}  // namespace object_modelling::features
