#include "object_modelling/rgbd/depth_in_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::rgbd
{
namespace
{
/// Sorted differences in mm where both have depth.
std::vector<double> differences_mm(const cv::Mat& a_m, const cv::Mat& b_m)
{
  std::vector<double> result;
  for (int v = 0; v < a_m.rows; ++v)
    for (int u = 0; u < a_m.cols; ++u)
      if (const double difference = std::abs(a_m.at<float>(v, u) - b_m.at<float>(v, u)); std::isfinite(difference))
        result.push_back(1e3 * difference);
  std::sort(result.begin(), result.end());
  return result;
}

class DepthInTime : public ::testing::Test
{
protected:
  cv::Mat depth(const Eigen::Isometry3d& T_moved) const
  {
    return test_support::renderFrame(test_support::boxOnTable(), camera_, T_world_camera_ * T_moved).depth_m;
  }

  geometry::PinholeCamera camera_ = test_support::vgaCamera();
  Eigen::Isometry3d T_world_camera_ = test_support::orbitPose({ 0, 0, 0.1 }, 0.7, 0.3, 0.6);
};

TEST_F(DepthInTime, IsWhatTheCameraSawFromTheOtherPlace)
{
  geometry::Vector6d motion;
  motion << 0.004, -0.003, 0.005, 0.008, -0.006, 0.01;
  const Eigen::Isometry3d T_color_depth = geometry::isometryFromVector(motion);
  const cv::Mat truth = depth(Eigen::Isometry3d::Identity()), given = depth(T_color_depth);
  const std::vector<double> before = differences_mm(given, truth);
  const std::vector<double> after = differences_mm(moveDepth(given, camera_, T_color_depth), truth);
  EXPECT_GT(before[before.size() / 2], 5);
  EXPECT_LT(after[after.size() / 2], 0.05);
  EXPECT_LT(after[after.size() * 97 / 100], 0.5);
  // All but the rim and the surroundings of steps keeps its depth.
  EXPECT_GT(after.size(), 0.94 * before.size());
}

TEST_F(DepthInTime, StaysWithoutMotion)
{
  const cv::Mat given = depth(Eigen::Isometry3d::Identity());
  const std::vector<double> after = differences_mm(moveDepth(given, camera_, Eigen::Isometry3d::Identity()), given);
  EXPECT_GT(after.size(), 0.99 * differences_mm(given, given).size());
  EXPECT_LT(after[after.size() * 99 / 100], 0.01);
}

TEST_F(DepthInTime, MissingDepthMovesAlong)
{
  cv::Mat given(camera_.height, camera_.width, CV_32FC1, cv::Scalar(1));
  given(cv::Rect(300, 200, 40, 40)) = std::numeric_limits<float>::quiet_NaN();
  // 10 px to the right.
  const Eigen::Isometry3d T_color_depth(Eigen::Translation3d(10 / camera_.fx, 0, 0));
  const cv::Mat moved = moveDepth(given, camera_, T_color_depth);
  EXPECT_TRUE(std::isnan(moved.at<float>(220, 345)));
  EXPECT_TRUE(std::isnan(moved.at<float>(220, 312)));
  EXPECT_NEAR(moved.at<float>(220, 355), 1, 1e-5);
  EXPECT_NEAR(moved.at<float>(220, 295), 1, 1e-5);
  // Uncovered.
  EXPECT_TRUE(std::isnan(moved.at<float>(220, 5)));
  given = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(cv::countNonZero(moveDepth(given, camera_, T_color_depth) == 1), 0);
}
}  // namespace
}  // namespace object_modelling::rgbd
