#include "support_around.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene_fixtures.h"

namespace object_modelling::segmentation
{
namespace
{
const Eigen::Isometry3d& pose()
{
  static const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0.1 }, 0.8, 0.6, 0.6);
  return T_world_camera;
}

geometry::Plane tableInCamera(double height_m = 0, double tilt_rad = 0)
{
  const Eigen::Vector3d normal = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()) * Eigen::Vector3d::UnitZ();
  return geometry::transformed(pose().inverse(), { normal, -height_m });
}

test_support::SceneImage view()
{
  return test_support::renderScene(test_support::boxOnTable(), test_support::vgaCamera(), pose(), kinectNoise());
}

const cv::Rect WHOLE(0, 0, 640, 480);

}  // namespace

TEST(RefineSupport, MendsAnOffsetOfThreeMillimetersAndATilt)
{
  const test_support::SceneImage image = view();
  for (const double height_m : { -0.003, 0.0, 0.003 })
  {
    const auto support = refineSupport(image.frame, tableInCamera(height_m, 0.01), WHOLE, {});
    ASSERT_TRUE(support) << height_m;
    const geometry::Plane table = geometry::transformed(pose(), support->plane_camera);
    EXPECT_NEAR(table.offset_m, 0, 0.0005) << height_m;
    EXPECT_GT(table.normal.z(), std::cos(0.003)) << height_m;
  }
}

TEST(RefineSupport, FindsNothingWhereThereIsNoTable)
{
  const test_support::SceneImage image = view();
  EXPECT_FALSE(refineSupport(image.frame, tableInCamera(0.5), WHOLE, {}));
  EXPECT_FALSE(refineSupport(image.frame, tableInCamera(), { 0, 0, 5, 5 }, {}));
  EXPECT_FALSE(refineSupport(image.frame, tableInCamera(), WHOLE, cv::Mat(480, 640, CV_8UC1, cv::Scalar(255))));
}

TEST(FindSupportAround, FindsTheTableUnderAMaskedObject)
{
  const test_support::SceneImage image = view();
  const auto support = findSupportAround(image.frame, image.frame.object_mask);
  ASSERT_TRUE(support);
  const geometry::Plane table = geometry::transformed(pose(), support->plane_camera);
  EXPECT_NEAR(table.offset_m, 0, 0.001);
  EXPECT_GT(table.normal.z(), 0.9999);
}

TEST(FindSupportAround, NeedsOnlyTheRingThatACropLeaves)
{
  test_support::SceneImage image = view();
  cv::Mat crop, depth_m(image.frame.depth_m.size(), CV_32FC1, cv::Scalar(std::nanf("")));
  const cv::Rect near = cv::Rect(240, 120, 180, 230);
  image.frame.depth_m(near).copyTo(depth_m(near));
  image.frame.depth_m = depth_m;
  const auto support = findSupportAround(image.frame, image.frame.object_mask);
  ASSERT_TRUE(support);
  EXPECT_GT(geometry::transformed(pose(), support->plane_camera).normal.z(), 0.9995);
}

TEST(FindSupportAround, DoesNotTakeAWallOrNothing)
{
  test_support::SyntheticScene scene;
  scene.has_table = false;
  scene.objects = { test_support::standingBox({ 0.1, 0.1, 0.2 }), test_support::standingBox({ 2, 0.05, 2 }, 0, 0.5) };
  const Eigen::Isometry3d T_world_camera = test_support::lookAt({ 0, -0.7, 0.3 }, { 0, 0, 0.1 });
  const test_support::SceneImage image =
      test_support::renderScene(scene, test_support::vgaCamera(), T_world_camera, kinectNoise());
  EXPECT_FALSE(findSupportAround(image.frame, image.frame.object_mask));
  EXPECT_FALSE(findSupportAround(image.frame, cv::Mat::zeros(480, 640, CV_8UC1)));
}

}  // namespace object_modelling::segmentation
