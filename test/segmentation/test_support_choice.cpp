#include "support_choice.h"

#include <gtest/gtest.h>

#include "scene_fixtures.h"
#include "support_extent.h"

namespace object_modelling::segmentation
{
TEST(SupportChoice, PrefersTheTableToALargerWall)
{
  test_support::SyntheticScene scene;
  scene.objects = { test_support::standingBox({ 3, 0.1, 2 }, 0, 0.65), test_support::standingBox({ 0.1, 0.1, 0.1 }) };
  // From low before the wall: it fills more of the image than the table.
  const Eigen::Isometry3d T_world_camera = test_support::lookAt({ 0, -0.7, 0.3 }, { 0, 0, 0.1 });
  const WorkingImage image =
      makeWorkingImage(test_support::renderFrame(scene, test_support::vgaCamera(), T_world_camera, kinectNoise()));
  const GrownPlanes planes = growPlanes(image, {});
  ASSERT_GE(planes.planes.size(), 2U);
  const std::vector<int> ranked = rankSupports(image, planes, 0.6);
  ASSERT_EQ(ranked.size(), planes.planes.size());
  const geometry::Plane best = geometry::transformed(T_world_camera, planes.planes[ranked.front()].plane);
  EXPECT_GT(best.normal.z(), 0.99);
}

TEST(SupportChoice, KnowsWhatLiesAbove)
{
  GrownPlane lower, upper;
  lower.plane = { Eigen::Vector3d::UnitZ(), 0 };
  upper.plane = { Eigen::Vector3d::UnitZ(), -0.05 };
  lower.moments.add(Eigen::Vector3d::Zero(), 1);
  upper.moments.add({ 0, 0, 0.05 }, 1);
  EXPECT_TRUE(liesAbove(upper, lower));
  EXPECT_FALSE(liesAbove(lower, upper));
  upper.plane.normal = Eigen::Vector3d(0, 1, 1).normalized();
  EXPECT_FALSE(liesAbove(upper, lower)) << "45 deg";
}

TEST(SupportExtent, CarriesWhatIsOverTheVisibleTable)
{
  test_support::SyntheticScene scene;
  scene.table_half_size_m = 0.2;
  const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0 }, 0.8, 0.3, 0.8);
  const WorkingImage image =
      makeWorkingImage(test_support::renderFrame(scene, test_support::vgaCamera(), T_world_camera));
  const GrownPlanes planes = growPlanes(image, {});
  ASSERT_EQ(planes.planes.size(), 1U);
  const SupportExtent extent(image, planes, 0);
  const auto carries = [&](double x_m, double y_m, double z_m)
  { return extent.carries(T_world_camera.inverse() * Eigen::Vector3d(x_m, y_m, z_m), 0.02); };
  EXPECT_TRUE(carries(0, 0, 0.3));
  EXPECT_TRUE(carries(0.18, 0.18, 0.1));
  EXPECT_TRUE(carries(0.2, 0, 0.1)) << "within the margin";
  EXPECT_FALSE(carries(0.25, 0, 0.1));
  EXPECT_FALSE(carries(-1, 0, 0.1));
}

}  // namespace object_modelling::segmentation
