#include "plane_growing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene_fixtures.h"

namespace object_modelling::segmentation
{
TEST(PlaneGrowing, FindsTheTableExactly)
{
  const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0.05 }, 0.8, 0.4, 0.7);
  const rgbd::Frame frame =
      test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(), T_world_camera, kinectNoise());
  const GrownPlanes planes = growPlanes(makeWorkingImage(frame), {});
  ASSERT_FALSE(planes.planes.empty());
  const geometry::Plane table = geometry::transformed(T_world_camera, planes.planes[0].plane);
  EXPECT_LT(std::acos(table.normal.z()) * 180 / M_PI, 0.2);
  EXPECT_NEAR(table.offset_m, 0, 0.0005);
  EXPECT_GE(planes.planes[0].noise_scale, 1);
  EXPECT_LT(planes.planes[0].noise_scale, 1.5);
}

TEST(PlaneGrowing, JoinsATableThatATallBoxCutsInTwo)
{
  test_support::SyntheticScene scene;
  scene.table_half_size_m = 0.4;
  scene.objects = { test_support::standingBox({ 0.02, 1.2, 0.1 }, 0, 0, 0) };
  const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0 }, 0.9, 0.2, 1.1);
  const rgbd::Frame frame = test_support::renderFrame(scene, test_support::vgaCamera(), T_world_camera, kinectNoise());
  const WorkingImage image = makeWorkingImage(frame);
  const GrownPlanes planes = growPlanes(image, {});
  ASSERT_FALSE(planes.planes.empty());
  int table_planes = 0;
  for (const GrownPlane& grown : planes.planes)
    table_planes += std::abs(geometry::transformed(T_world_camera, grown.plane).offset_m) < 0.01;
  EXPECT_EQ(table_planes, 1);
}

TEST(PlaneGrowing, KeepsAStepOfTwoCentimetersApart)
{
  test_support::SyntheticScene scene;
  scene.objects = { test_support::standingBox({ 0.4, 0.4, 0.02 }) };
  const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0 }, 0.9, 0, 0.8);
  const GrownPlanes planes = growPlanes(
      makeWorkingImage(test_support::renderFrame(scene, test_support::vgaCamera(), T_world_camera, kinectNoise())), {});
  ASSERT_GE(planes.planes.size(), 2U);
  std::vector<double> heights_m;
  for (int i = 0; i < 2; ++i)
    heights_m.push_back(-geometry::transformed(T_world_camera, planes.planes[i].plane).offset_m);
  std::sort(heights_m.begin(), heights_m.end());
  EXPECT_NEAR(heights_m[0], 0, 0.001);
  EXPECT_NEAR(heights_m[1], 0.02, 0.001);
}

TEST(PlaneGrowing, MeasuresARougherPlaneThanTheModel)
{
  test_support::SensorNoise noise = kinectNoise();
  noise.depth_sigma_scale = 2;
  const rgbd::Frame frame = test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(),
                                                      test_support::orbitPose({ 0, 0, 0 }, 0.8, 0, 0.8), noise);
  const GrownPlanes planes = growPlanes(makeWorkingImage(frame), {});
  ASSERT_FALSE(planes.planes.empty());
  EXPECT_GT(planes.planes[0].noise_scale, 1.4);
}

TEST(PlaneGrowing, WorkingImageLeavesOutWhatIsIgnored)
{
  const rgbd::Frame frame = test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(),
                                                      test_support::orbitPose({ 0, 0, 0 }, 0.8, 0, 0.8));
  const cv::Mat everything(frame.depth_m.size(), CV_8UC1, cv::Scalar(255));
  const WorkingImage image = makeWorkingImage(frame, everything);
  EXPECT_EQ(cv::countNonZero(image.frame.depth_m == image.frame.depth_m), 0);
  EXPECT_TRUE(growPlanes(image, {}).planes.empty());
}

TEST(PlaneGrowing, WorkingPixelsAreFramePixels)
{
  const rgbd::Frame frame = test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(),
                                                      test_support::orbitPose({ 0, 0, 0 }, 0.8, 0, 0.8));
  const WorkingImage image = makeWorkingImage(frame);
  EXPECT_GT(image.step, 1);
  const Eigen::Vector3f p = image.frame.point(50, 100), q = frame.point(50 * image.step, 100 * image.step);
  EXPECT_LT((p - q).norm(), 1e-5F);
}

}  // namespace object_modelling::segmentation
