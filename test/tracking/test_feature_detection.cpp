#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "feature_detector.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"
#include "wide_baseline_features.h"

namespace object_modelling::tracking
{
namespace
{
rgbd::Frame view(double azimuth_rad)
{
  return test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(),
                                   test_support::orbitPose({ 0, 0, 0.08 }, 0.7, azimuth_rad, 0.6));
}
}  // namespace

TEST(FeatureDetector, KeepsToTheMaskAndAwayFromOldFeatures)
{
  const rgbd::Frame frame = view(0);
  FeatureDetectorOptions options;
  options.max_features = 100;
  const std::vector<Eigen::Vector2f> first = detectFeatures(frame.gray, frame.object_mask, {}, options);
  ASSERT_GT(first.size(), 20u);
  for (const Eigen::Vector2f& pixel : first)
    EXPECT_NE(frame.object_mask.at<std::uint8_t>(std::lround(pixel.y()), std::lround(pixel.x())), 0);
  const std::vector<Eigen::Vector2f> occupied(first.begin(), first.begin() + 20);
  const std::vector<Eigen::Vector2f> second = detectFeatures(frame.gray, {}, occupied, options);
  EXPECT_LE(second.size(), 80u);
  for (const Eigen::Vector2f& a : second)
    for (const Eigen::Vector2f& b : occupied)
      EXPECT_GE((a - b).norm(), options.min_distance_px - 1);
}

TEST(FeatureDetector, FindsNothingInPlainOrTinyImages)
{
  EXPECT_TRUE(detectFeatures(cv::Mat(100, 100, CV_8UC1, cv::Scalar(77)), {}, {}, {}).empty());
  EXPECT_TRUE(detectFeatures(cv::Mat(10, 10, CV_8UC1, cv::Scalar(77)), {}, {}, {}).empty());
}

TEST(FeatureDetector, HalfResolutionFindsTheSameCornersInFullPixels)
{
  cv::Mat gray(480, 640, CV_8UC1, cv::Scalar(60));
  cv::Mat inner = gray(cv::Rect(200, 100, 240, 160));
  inner.setTo(180);
  const std::vector<Eigen::Vector2f> found = detectFeatures(registration::ImagePyramid(gray), {}, {}, {});
  EXPECT_EQ(found.size(), 4u);
  for (const Eigen::Vector2f& corner : { Eigen::Vector2f(199.5F, 99.5F), Eigen::Vector2f(439.5F, 99.5F),
                                         Eigen::Vector2f(199.5F, 259.5F), Eigen::Vector2f(439.5F, 259.5F) })
  {
    float nearest_px = 1e9F;
    for (const Eigen::Vector2f& pixel : found)
      nearest_px = std::min(nearest_px, (pixel - corner).norm());
    EXPECT_LT(nearest_px, 4.5F) << corner.transpose();
  }
}

TEST(FeatureDetector, HalfResolutionKeepsToTheMaskAndAwayFromOldFeatures)
{
  const rgbd::Frame frame = view(0);
  const registration::ImagePyramid pyramid(frame.gray);
  FeatureDetectorOptions options;
  options.max_features = 100;
  const std::vector<Eigen::Vector2f> first = detectFeatures(pyramid, frame.object_mask, {}, options);
  ASSERT_GT(first.size(), 20u);
  for (const Eigen::Vector2f& pixel : first)
    EXPECT_NE(frame.object_mask.at<std::uint8_t>(std::lround(pixel.y()), std::lround(pixel.x())), 0);
  const std::vector<Eigen::Vector2f> occupied(first.begin(), first.begin() + 20);
  const std::vector<Eigen::Vector2f> second = detectFeatures(pyramid, {}, occupied, options);
  EXPECT_LE(second.size(), 80u);
  for (const Eigen::Vector2f& a : second)
  {
    EXPECT_GE(a.x(), options.border_px - 1);
    EXPECT_GE(a.y(), options.border_px - 1);
    EXPECT_LE(a.x(), frame.gray.cols - options.border_px);
    EXPECT_LE(a.y(), frame.gray.rows - options.border_px);
    for (const Eigen::Vector2f& b : occupied)
      EXPECT_GE((a - b).norm(), options.min_distance_px - 2);
  }
}

TEST(FeatureDetector, SmallImagesAreSearchedAtFullResolution)
{
  cv::Mat small;
  cv::resize(view(0).gray, small, cv::Size(320, 240), 0, 0, cv::INTER_AREA);
  const std::vector<Eigen::Vector2f> by_pyramid = detectFeatures(registration::ImagePyramid(small), {}, {}, {});
  const std::vector<Eigen::Vector2f> by_image = detectFeatures(small, {}, {}, {});
  ASSERT_FALSE(by_image.empty());
  EXPECT_EQ(by_pyramid, by_image);
}

TEST(FeatureDetector, TakesNoNoiseForCorners)
{
  cv::Mat noise(480, 640, CV_8UC1);
  cv::theRNG().state = 7;
  cv::randn(noise, 120, 2);
  EXPECT_TRUE(detectFeatures(registration::ImagePyramid(noise), {}, {}, {}).empty());
  EXPECT_TRUE(detectFeatures(noise, {}, {}, {}).empty());
  FeatureDetectorOptions any;
  any.min_gradient = 0;
  EXPECT_GT(detectFeatures(registration::ImagePyramid(noise), {}, {}, any).size(), 100u);
  // Print of twenty grey levels stands out from it.
  noise(cv::Rect(200, 100, 240, 160)) += 20;
  EXPECT_EQ(detectFeatures(registration::ImagePyramid(noise), {}, {}, {}).size(), 4u);
}

TEST(WideBaselineFeatures, MatchAcrossAnglesByKind)
{
  const auto matches = [](FeatureKind kind, double turn_rad)
  {
    return matchFeatures(detectWideBaselineFeatures(view(0), kind), detectWideBaselineFeatures(view(turn_rad), kind))
        .size();
  };
  EXPECT_GT(matches(FeatureKind::QUICK, 0.2), 15u);
  EXPECT_GT(matches(FeatureKind::ROBUST, 0.35), 15u);
  EXPECT_TRUE(matchFeatures(detectWideBaselineFeatures(view(0), FeatureKind::QUICK), {}).empty());
}

/// A camera that is held upside down sees the same points: what shifts them would be found twice here.
TEST(WideBaselineFeatures, LieOnTheSamePointsOfAnImageTurnedRound)
{
  const rgbd::Frame upright = view(0);
  rgbd::Frame turned;
  cv::rotate(upright.gray, turned.gray, cv::ROTATE_180);
  cv::rotate(upright.depth_m, turned.depth_m, cv::ROTATE_180);
  const WideBaselineFeatures a = detectWideBaselineFeatures(upright, FeatureKind::ROBUST);
  const WideBaselineFeatures b = detectWideBaselineFeatures(turned, FeatureKind::ROBUST);
  const std::vector<features::DescriptorMatch> matches = matchFeatures(a, b);
  ASSERT_GT(matches.size(), 50u);
  const Eigen::Vector2f last(upright.gray.cols - 1, upright.gray.rows - 1);
  std::vector<float> u, v;
  for (const features::DescriptorMatch& match : matches)
  {
    const Eigen::Vector2f off = last - b.pixels[match.b] - a.pixels[match.a];
    u.push_back(off.x());
    v.push_back(off.y());
  }
  for (std::vector<float>* off : { &u, &v })
  {
    std::nth_element(off->begin(), off->begin() + off->size() / 2, off->end());
    EXPECT_NEAR((*off)[off->size() / 2], 0, 0.05) << "0.5 with OpenCV's own pixels of SIFT";
  }
}
}  // namespace object_modelling::tracking
