#include "pedestal.h"

#include <cmath>

#include <gtest/gtest.h>

#include "turntable_scene.h"

namespace object_modelling::segmentation
{
namespace
{
geometry::Plane planeAt(double height_m)
{
  const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0.05 }, 0.75, 0.4, 0.6);
  return geometry::transformed(T_world_camera.inverse(), { Eigen::Vector3d::UnitZ(), -height_m });
}
}  // namespace

TEST(Pedestal, IsTheTopOfATurntableWithoutItsRim)
{
  for (const double turn_rad : { 0.0, 1.0, 2.5 })
  {
    const test_support::SceneImage image = turntableView(turn_rad);
    const cv::Mat box = image.instances == 1, disc = image.instances == 2;
    const cv::Mat pedestal = findPedestal(image.frame, planeAt(0.02), box, {});
    ASSERT_FALSE(pedestal.empty()) << turn_rad;
    EXPECT_GT(shareWithin(pedestal, disc), 0.99) << turn_rad;
    EXPECT_GT(shareWithin(disc, pedestal), 0.75) << turn_rad;
    EXPECT_EQ(cv::countNonZero(pedestal & box), 0);
  }
}

TEST(Pedestal, IsNoTable)
{
  const test_support::SceneImage image =
      test_support::renderScene(test_support::boxOnTable(), test_support::vgaCamera(),
                                test_support::orbitPose({ 0, 0, 0.05 }, 0.75, 0.4, 0.6), kinectNoise());
  EXPECT_TRUE(findPedestal(image.frame, planeAt(0), image.instances == 1, {}).empty());
}

TEST(Pedestal, IsNoSheetThatLiesOnTheTable)
{
  const test_support::SceneImage image = turntableView(0, 1, 0.003);
  EXPECT_TRUE(findPedestal(image.frame, planeAt(0.003), image.instances == 1, {}).empty());
}

TEST(Pedestal, IsNoSaucer)
{
  const test_support::SceneImage image = turntableView(0, 1, 0.02, 0.18);
  EXPECT_TRUE(findPedestal(image.frame, planeAt(0.02), image.instances == 1, {}).empty());
}

TEST(Pedestal, IsNotLargerThanAllowed)
{
  const test_support::SceneImage image = turntableView(0);
  PedestalOptions options;
  options.max_size_m = 0.3;
  EXPECT_TRUE(findPedestal(image.frame, planeAt(0.02), image.instances == 1, options).empty());
  options.max_size_m = 0.4;
  EXPECT_FALSE(findPedestal(image.frame, planeAt(0.02), image.instances == 1, options).empty());
}

TEST(Pedestal, IsNothingWithoutDepthOrObject)
{
  test_support::SceneImage image = turntableView(0);
  const cv::Mat box = image.instances == 1;
  EXPECT_TRUE(findPedestal(image.frame, planeAt(0.02), cv::Mat::zeros(box.size(), CV_8UC1), {}).empty());
  image.frame.depth_m = cv::Mat(box.size(), CV_32FC1, cv::Scalar(std::nanf("")));
  EXPECT_TRUE(findPedestal(image.frame, planeAt(0.02), box, {}).empty());
}

}  // namespace object_modelling::segmentation
