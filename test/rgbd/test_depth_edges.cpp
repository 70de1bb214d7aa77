#include "object_modelling/rgbd/depth_edges.h"

#include <gtest/gtest.h>

#include <limits>

#include "object_modelling/base/status.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::rgbd
{
namespace
{
/// Left half at `left_m`, right half (from column 5) at `right_m`.
Frame stepFrame(float left_m, float right_m)
{
  Frame frame;
  frame.depth_m = cv::Mat(6, 10, CV_32FC1, cv::Scalar(left_m));
  frame.depth_m.colRange(5, 10) = right_m;
  return frame;
}

TEST(DepthEdges, StepIsOccludingOnTheNearSideAndOccludedOnTheFar)
{
  const cv::Mat edges = findDepthEdges(stepFrame(1.0f, 1.05f));
  for (int v = 0; v < 6; ++v)
    for (int u = 0; u < 10; ++u)
      EXPECT_EQ(edges.at<std::uint8_t>(v, u), u == 4 ? OCCLUDING : u == 5 ? OCCLUDED : NO_EDGE) << u << ", " << v;
  const cv::Mat mirrored = findDepthEdges(stepFrame(1.05f, 1.0f));
  EXPECT_EQ(mirrored.at<std::uint8_t>(2, 4), OCCLUDED);
  EXPECT_EQ(mirrored.at<std::uint8_t>(2, 5), OCCLUDING);
}

TEST(DepthEdges, ThresholdGrowsWithDepth)
{
  EXPECT_EQ(cv::countNonZero(findDepthEdges(stepFrame(0.5f, 0.509f))), 0);
  EXPECT_GT(cv::countNonZero(findDepthEdges(stepFrame(0.5f, 0.511f))), 0);
  EXPECT_EQ(cv::countNonZero(findDepthEdges(stepFrame(2.0f, 2.039f))), 0);
  EXPECT_GT(cv::countNonZero(findDepthEdges(stepFrame(2.0f, 2.041f))), 0);
}

TEST(DepthEdges, HoleMarksItsNeighborsOnly)
{
  Frame frame = stepFrame(1, 1);
  frame.depth_m.at<float>(3, 2) = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat edges = findDepthEdges(frame);
  EXPECT_EQ(cv::countNonZero(edges), 4);
  EXPECT_EQ(edges.at<std::uint8_t>(3, 2), NO_EDGE);
  EXPECT_EQ(edges.at<std::uint8_t>(3, 1), MISSING_DATA);
  EXPECT_EQ(edges.at<std::uint8_t>(2, 2), MISSING_DATA);
}

TEST(DepthEdges, KindsCombine)
{
  Frame frame = stepFrame(1, 2);
  frame.depth_m.at<float>(2, 4) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(findDepthEdges(frame).at<std::uint8_t>(3, 4), OCCLUDING | MISSING_DATA);
}

TEST(DepthEdges, NoDepthAtAllAndOnePixel)
{
  Frame frame = stepFrame(1, 1);
  frame.depth_m = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(cv::countNonZero(findDepthEdges(frame)), 0);
  frame.depth_m = cv::Mat::ones(1, 1, CV_32FC1);
  EXPECT_EQ(cv::countNonZero(findDepthEdges(frame)), 0);
}

TEST(DepthEdges, SlantedTableHasNoEdges)
{
  test_support::SyntheticScene scene;
  scene.table_half_size_m = 100;
  const Frame frame =
      test_support::renderFrame(scene, test_support::vgaCamera(), test_support::orbitPose({ 0, 0, 0 }, 0.8, 0.3, 0.7));
  EXPECT_EQ(cv::countNonZero(findDepthEdges(frame)), 0);
}

TEST(DistanceToEdges, KnownDistancesPerKind)
{
  const cv::Mat edges = findDepthEdges(stepFrame(1, 2));
  const cv::Mat to_any = distanceToEdges_px(edges);
  ASSERT_EQ(to_any.type(), CV_32FC1);
  EXPECT_EQ(to_any.at<float>(3, 4), 0);
  EXPECT_EQ(to_any.at<float>(3, 1), 3);
  EXPECT_EQ(to_any.at<float>(3, 8), 3);
  const cv::Mat to_occluded = distanceToEdges_px(edges, OCCLUDED);
  EXPECT_EQ(to_occluded.at<float>(3, 4), 1);
  EXPECT_EQ(to_occluded.at<float>(3, 1), 4);
}

TEST(DistanceToEdges, DiagonalIsEuclidean)
{
  cv::Mat edges = cv::Mat::zeros(20, 20, CV_8UC1);
  edges.at<std::uint8_t>(0, 0) = OCCLUDING;
  EXPECT_NEAR(distanceToEdges_px(edges).at<float>(4, 3), 5, 1e-5);
}

TEST(DistanceToEdges, WithoutEdgesEverythingIsFar)
{
  const cv::Mat distance = distanceToEdges_px(cv::Mat::zeros(6, 10, CV_8UC1));
  EXPECT_EQ(cv::countNonZero(distance == 16.0f), 60);
  EXPECT_EQ(cv::countNonZero(distanceToEdges_px(findDepthEdges(stepFrame(1, 2)), MISSING_DATA) == 16.0f), 60);
}

TEST(DepthEdges, RefusesBadOptions)
{
  EXPECT_THROW(findDepthEdges(stepFrame(1, 2), { 0.0 }), base::Error);
  EXPECT_THROW(findDepthEdges(stepFrame(1, 2), { std::numeric_limits<double>::quiet_NaN() }), base::Error);
}

}  // namespace
}  // namespace object_modelling::rgbd
