#include "object_modelling/segmentation/smooth_clustering.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace object_modelling::segmentation
{
namespace
{
constexpr float MISSING = std::numeric_limits<float>::quiet_NaN();

/// A camera that looks straight down on a plane at 1 m.
rgbd::Frame flatFrame()
{
  rgbd::Frame frame;
  frame.camera.width = 100;
  frame.camera.height = 80;
  frame.camera.fx = frame.camera.fy = 100;
  frame.camera.cx = 49.5;
  frame.camera.cy = 39.5;
  frame.depth_m = cv::Mat(80, 100, CV_32FC1, cv::Scalar(1.0));
  return frame;
}

geometry::Plane floorPlane()
{
  return { -Eigen::Vector3d::UnitZ(), 1.0 };
}

void raise(rgbd::Frame* frame, const cv::Rect& rect, double height_m)
{
  frame->depth_m(rect) = cv::Scalar(1.0 - height_m);
}

Clusters cluster(const rgbd::Frame& frame, int min_pixels = 10)
{
  return clusterSmooth(frame, pixelsAbove(frame, floorPlane(), {}, 0.015), 0.015, min_pixels);
}

}  // namespace

TEST(PixelsAbove, GradesHeights)
{
  rgbd::Frame frame = flatFrame();
  raise(&frame, { 10, 10, 10, 10 }, 0.002);
  raise(&frame, { 30, 10, 10, 10 }, 0.005);
  raise(&frame, { 50, 10, 10, 10 }, 0.05);
  raise(&frame, { 70, 10, 10, 10 }, 0.7);
  const cv::Mat above = pixelsAbove(frame, floorPlane(), {}, 0.015);
  EXPECT_EQ(above.at<std::uint8_t>(40, 50), BELOW);
  EXPECT_EQ(above.at<std::uint8_t>(15, 15), BELOW);
  EXPECT_EQ(above.at<std::uint8_t>(15, 35), LOW);
  EXPECT_EQ(above.at<std::uint8_t>(15, 55), HIGH);
  EXPECT_EQ(above.at<std::uint8_t>(15, 75), BELOW) << "higher than max_m";
}

TEST(PixelsAbove, LeavesOutFlyingPixelsMissingOnesAndWhatIsFar)
{
  rgbd::Frame frame = flatFrame();
  raise(&frame, { 10, 10, 1, 1 }, 0.1);
  raise(&frame, { 30, 10, 10, 10 }, 0.1);
  frame.depth_m.at<float>(15, 35) = MISSING;
  cv::Mat above = pixelsAbove(frame, floorPlane(), {}, 0.015);
  EXPECT_EQ(above.at<std::uint8_t>(10, 10), BELOW);
  EXPECT_EQ(above.at<std::uint8_t>(15, 35), BELOW);
  EXPECT_EQ(cv::countNonZero(above), 99);
  HeightLimits near;
  near.max_distance_m = 0.5;
  EXPECT_EQ(cv::countNonZero(pixelsAbove(frame, floorPlane(), near, 0.015)), 0);
  EXPECT_EQ(cv::countNonZero(pixelsAbove(frame, floorPlane(), {}, 0.015, { 0, 0, 20, 20 })), 0);
}

TEST(ClusterSmooth, SeparatesByDepthSteps)
{
  rgbd::Frame frame = flatFrame();
  raise(&frame, { 10, 10, 20, 20 }, 0.10);
  raise(&frame, { 30, 10, 10, 20 }, 0.14);  // touches the first in the image, 4 cm nearer
  const Clusters clusters = cluster(frame);
  ASSERT_EQ(clusters.clusters.size(), 2U);
  EXPECT_EQ(clusters.clusters[0].pixel_count, 400);
  EXPECT_EQ(clusters.clusters[0].rect, cv::Rect(10, 10, 20, 20));
  EXPECT_EQ(clusters.clusters[1].rect, cv::Rect(30, 10, 10, 20));
  EXPECT_EQ(cv::countNonZero(clusters.mask(clusters.clusters[1])), 200);
}

TEST(ClusterSmooth, BridgesNarrowGapsInTheDepth)
{
  rgbd::Frame frame = flatFrame();
  raise(&frame, { 10, 10, 40, 20 }, 0.10);
  frame.depth_m(cv::Rect(20, 10, 2, 20)) = cv::Scalar(MISSING);
  ASSERT_EQ(cluster(frame).clusters.size(), 1U);
  frame.depth_m(cv::Rect(20, 10, 4, 20)) = cv::Scalar(MISSING);
  EXPECT_EQ(cluster(frame).clusters.size(), 2U);
}

TEST(ClusterSmooth, JoinsShapesThatMeetLate)
{
  rgbd::Frame frame = flatFrame();  // a U: its arms meet in the last rows only
  raise(&frame, { 10, 10, 5, 40 }, 0.10);
  raise(&frame, { 40, 10, 5, 40 }, 0.10);
  raise(&frame, { 10, 45, 35, 5 }, 0.10);
  const Clusters clusters = cluster(frame);
  ASSERT_EQ(clusters.clusters.size(), 1U);
  EXPECT_EQ(clusters.clusters[0].pixel_count, 2 * 5 * 40 + 25 * 5);
}

TEST(ClusterSmooth, GrowsByTheFootButNotAlongTheTable)
{
  rgbd::Frame frame = flatFrame();
  raise(&frame, { 10, 10, 20, 20 }, 0.012);
  raise(&frame, { 10, 30, 20, 3 }, 0.005);
  raise(&frame, { 60, 10, 20, 20 }, 0.005);  // low, and nothing above it
  const Clusters clusters = cluster(frame);
  ASSERT_EQ(clusters.clusters.size(), 1U);
  EXPECT_EQ(clusters.clusters[0].rect, cv::Rect(10, 10, 20, 23));
}

TEST(ClusterSmooth, DropsSmallOnes)
{
  rgbd::Frame frame = flatFrame();
  raise(&frame, { 10, 10, 4, 4 }, 0.10);
  EXPECT_TRUE(cluster(frame, 17).clusters.empty());
  EXPECT_EQ(cluster(frame, 16).clusters.size(), 1U);
}

}  // namespace object_modelling::segmentation
