#include "joint_motion.h"

#include <gtest/gtest.h>

#include "turntable_scene.h"

namespace object_modelling::segmentation
{
namespace
{
/// A printed box on a printed disc, each turned by its own angle.
bool show(JointMotion* joint, double box_rad, double disc_rad)
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  scene.objects.push_back(test_support::standingCylinder(0.36, 0.02));
  scene.objects[0].T_world_object.pretranslate(Eigen::Vector3d(0, 0, 0.02));
  scene.objects[0].T_world_object.rotate(Eigen::AngleAxisd(box_rad, Eigen::Vector3d::UnitZ()));
  scene.objects[1].T_world_object.rotate(Eigen::AngleAxisd(disc_rad, Eigen::Vector3d::UnitZ()));
  test_support::SensorNoise noise = kinectNoise(static_cast<std::uint64_t>(1000 * (box_rad + disc_rad + 1)));
  noise.color_sigma = 2;
  const test_support::SceneImage image =
      test_support::renderScene(scene, smallCamera(), test_support::orbitPose({ 0, 0, 0.05 }, 0.75, 0.4, 0.6), noise);
  return joint->together(image.frame.gray, image.instances == 1, image.instances == 2);
}
}  // namespace

TEST(JointMotion, ATurntableGoesWithItsObject)
{
  JointMotion joint;
  for (int i = 0; i < 40; ++i)
    EXPECT_TRUE(show(&joint, 0.02 * i, 0.02 * i)) << i;
}

TEST(JointMotion, ATrayThatStandsStillDoesNotUntilItMoves)
{
  JointMotion joint;
  int noticed = -1;
  for (int i = 0; i < 40 && noticed < 0; ++i)
    if (!show(&joint, 0.02 * i, 0))
      noticed = i;
  EXPECT_GE(noticed, 0);
  EXPECT_LT(noticed, 25) << "half a radian";
  EXPECT_FALSE(show(&joint, 0.02 * noticed + 0.3, 0));
  EXPECT_TRUE(show(&joint, 0.02 * noticed + 0.6, 0.5));
}

TEST(JointMotion, NothingFollowsFromRest)
{
  JointMotion joint;
  for (int i = 0; i < 70; ++i)
    EXPECT_TRUE(show(&joint, 0, 0)) << i;
}

}  // namespace object_modelling::segmentation
