#include "low_holes.h"

#include <limits>

#include <gtest/gtest.h>

namespace object_modelling::segmentation
{
namespace
{
/// A ring in the mask round a hole of 10x10 px, seen from above at 1 m.
struct Ring
{
  rgbd::Frame frame;
  geometry::Plane plane{ -Eigen::Vector3d::UnitZ(), 1.0 };
  cv::Mat mask = cv::Mat::zeros(60, 60, CV_8UC1);
  cv::Rect rect{ 10, 10, 30, 30 };

  explicit Ring(double hole_height_m)
  {
    frame.camera.width = frame.camera.height = 60;
    frame.camera.fx = frame.camera.fy = 60;
    frame.depth_m = cv::Mat(60, 60, CV_32FC1, cv::Scalar(1.0));
    frame.depth_m(rect) = cv::Scalar(0.95);
    mask(rect) = cv::Scalar(255);
    frame.depth_m(cv::Rect(20, 20, 10, 10)) = cv::Scalar(1.0 - hole_height_m);
    mask(cv::Rect(20, 20, 10, 10)) = cv::Scalar(0);
  }
  int fill()
  {
    fillLowHoles(frame, plane, 0.003, 0.6, rect, &mask);
    return cv::countNonZero(mask(cv::Rect(20, 20, 10, 10)));
  }
};

}  // namespace

TEST(LowHoles, TakesTheFloorOfABowl)
{
  EXPECT_EQ(Ring(0.003).fill(), 100);
}

TEST(LowHoles, LeavesTheTableSeenThroughAHandle)
{
  EXPECT_EQ(Ring(0.0).fill(), 0);
  EXPECT_EQ(Ring(0.001).fill(), 0);
  EXPECT_EQ(Ring(-0.5).fill(), 0) << "through a hole over the table's edge";
}

TEST(LowHoles, LeavesMissingDepthAndOpenBays)
{
  Ring missing(0.003);
  missing.frame.depth_m(cv::Rect(20, 20, 10, 5)) = cv::Scalar(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(missing.fill(), 50);
  Ring open(0.003);
  open.mask(cv::Rect(24, 10, 2, 10)) = cv::Scalar(0);
  EXPECT_EQ(open.fill(), 0);
}

}  // namespace object_modelling::segmentation
