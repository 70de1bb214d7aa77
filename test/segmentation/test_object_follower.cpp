#include "object_modelling/segmentation/object_follower.h"

#include <cmath>

#include <gtest/gtest.h>

#include "turntable_scene.h"

namespace object_modelling::segmentation
{
using base::StatusCode;

namespace
{
test_support::SyntheticScene twoBoxes()
{
  test_support::SyntheticScene scene;
  scene.objects = { test_support::standingBox({ 0.08, 0.08, 0.12 }, -0.12, 0),
                    test_support::standingBox({ 0.08, 0.08, 0.12 }, 0.12, 0, 0, 9) };
  return scene;
}

rgbd::Frame unmasked(rgbd::Frame frame)
{
  frame.object_mask.release();
  return frame;
}

const Eigen::Isometry3d& pose()
{
  static const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0.05 }, 0.6, -M_PI / 2, 0.6);
  return T_world_camera;
}
}  // namespace

TEST(ObjectFollower, FindsTheObjectAndWhatTurnsWithIt)
{
  ObjectFollower follower;
  for (int i = 0; i < 12; ++i)
  {
    const test_support::SceneImage image = turntableView(0.5 * i, i + 1);
    const cv::Mat box = image.instances == 1, disc = image.instances == 2;
    const FollowedObject found = follower.follow(unmasked(image.frame));
    ASSERT_TRUE(found.status.ok()) << i << ": " << found.status.message;
    EXPECT_GT(overlap(found.mask, box, image.frame.depth_m), 0.85) << i;
    ASSERT_FALSE(found.turntable.empty()) << i;
    EXPECT_GT(shareWithin(found.turntable, disc | box), 0.99) << i;  // the foot of the box may be on either side
    EXPECT_GT(shareWithin(disc, found.turntable), 0.7) << i;
    EXPECT_EQ(cv::countNonZero(found.moving()), cv::countNonZero(found.mask | found.turntable));
  }
}

TEST(ObjectFollower, TakesNoTableForATurntable)
{
  ObjectFollower follower;
  for (int i = 0; i < 3; ++i)
  {
    const test_support::SceneImage image =
        test_support::renderScene(test_support::boxOnTable(), smallCamera(),
                                  test_support::orbitPose({ 0, 0, 0.08 }, 0.6, 0.05 * i, 0.6), kinectNoise(i + 1));
    const FollowedObject found = follower.follow(unmasked(image.frame));
    ASSERT_TRUE(found.status.ok()) << found.status.message;
    EXPECT_TRUE(found.turntable.empty());
    EXPECT_GT(overlap(found.mask, image.instances == 1, image.frame.depth_m), 0.85);
  }
}

TEST(ObjectFollower, LeavesTurntablesOutWhereToldTo)
{
  ObjectFollowerOptions options;
  options.max_turntable_size_m = 0;
  ObjectFollower follower(options);
  const FollowedObject found = follower.follow(unmasked(turntableView(0).frame));
  ASSERT_TRUE(found.status.ok()) << found.status.message;
  EXPECT_TRUE(found.turntable.empty());
  EXPECT_EQ(cv::countNonZero(found.moving() != found.mask), 0);
}

TEST(ObjectFollower, KeepsTheMasksThatAFrameBrings)
{
  ObjectFollower follower;
  const rgbd::Frame frame = turntableView(0).frame;
  ASSERT_FALSE(frame.object_mask.empty());
  const FollowedObject found = follower.follow(frame);
  EXPECT_TRUE(found.status.ok());
  EXPECT_EQ(cv::countNonZero(found.moving() != frame.object_mask), 0);
}

TEST(ObjectFollower, TurntableGoesOnToCountWhereSomeFramesBringMasks)
{
  ObjectFollower follower;
  for (int i = 0; i < 9; ++i)
  {
    const test_support::SceneImage image = turntableView(0.1 * i, i + 1);
    const bool with_mask = i % 3 == 0;
    const FollowedObject found = follower.follow(with_mask ? image.frame : unmasked(image.frame));
    ASSERT_TRUE(found.status.ok()) << i << ": " << found.status.message;
    if (with_mask)
    {
      EXPECT_EQ(cv::countNonZero(found.mask != image.frame.object_mask), 0) << i;
    }
    if (i == 0)
      continue;
    ASSERT_FALSE(found.turntable.empty()) << i;
    EXPECT_GT(shareWithin(image.instances == 2, found.turntable), 0.7) << i;
  }
}

TEST(ObjectFollower, MaskWithoutAPixelIsNoObjectInThatFrame)
{
  ObjectFollower follower;
  ASSERT_TRUE(follower.follow(unmasked(turntableView(0, 1).frame)).status.ok());
  rgbd::Frame frame = turntableView(0.1, 2).frame;
  frame.object_mask = cv::Mat::zeros(frame.depth_m.size(), CV_8UC1);
  const FollowedObject none = follower.follow(frame);
  EXPECT_TRUE(none.status.ok());
  EXPECT_EQ(cv::countNonZero(none.moving()), 0);
  const test_support::SceneImage after = turntableView(0.2, 3);
  const FollowedObject found = follower.follow(unmasked(after.frame));
  ASSERT_TRUE(found.status.ok()) << found.status.message;
  EXPECT_GT(overlap(found.mask, after.instances == 1, after.frame.depth_m), 0.85);
}

TEST(ObjectFollower, StaysWithTheObjectItHas)
{
  const test_support::SceneImage both = test_support::renderScene(twoBoxes(), smallCamera(), pose());
  for (const int wanted : { 1, 2 })
  {
    ObjectFollower follower;
    rgbd::Frame first = both.frame;
    first.object_mask = both.instances == wanted;
    ASSERT_TRUE(follower.follow(first).status.ok());
    for (int i = 0; i < 3; ++i)
    {
      const FollowedObject found = follower.follow(unmasked(both.frame));
      ASSERT_TRUE(found.status.ok());
      EXPECT_GT(overlap(found.mask, both.instances == wanted, both.frame.depth_m), 0.75) << wanted;
    }
  }
}

TEST(ObjectFollower, SaysWhenTheObjectIsGoneAndChoosesAnewLater)
{
  test_support::SyntheticScene scene = twoBoxes();
  ObjectFollower follower;
  rgbd::Frame first = test_support::renderFrame(scene, smallCamera(), pose());
  ASSERT_TRUE(follower.follow(first).status.ok());  // with the mask of the first box
  scene.objects.erase(scene.objects.begin());
  const rgbd::Frame alone = unmasked(test_support::renderFrame(scene, smallCamera(), pose()));
  const FollowedObject gone = follower.follow(alone);
  EXPECT_EQ(gone.status.code, StatusCode::NO_RESULT);
  EXPECT_NE(gone.status.message.find("left the view or was covered"), std::string::npos) << gone.status.message;
  EXPECT_TRUE(gone.moving().empty());
  int frames = 1;
  while (!follower.follow(alone).status.ok() && frames < 100)
    ++frames;
  EXPECT_GT(frames, 5);
  EXPECT_LT(frames, 31) << "within a second";
}

TEST(ObjectFollower, FindsNothingOnAnEmptyTableOrWithoutDepth)
{
  ObjectFollower follower;
  rgbd::Frame frame = unmasked(test_support::renderFrame(test_support::SyntheticScene(), smallCamera(),
                                                         test_support::orbitPose({ 0, 0, 0 }, 0.6, 0, 0.6)));
  EXPECT_EQ(follower.follow(frame).status.code, StatusCode::NO_RESULT);
  ASSERT_TRUE(follower.follow(unmasked(turntableView(0).frame)).status.ok());
  frame = unmasked(turntableView(0).frame);
  frame.depth_m = cv::Mat(frame.depth_m.size(), CV_32FC1, cv::Scalar(std::nanf("")));
  EXPECT_EQ(follower.follow(frame).status.code, StatusCode::NO_RESULT);
  EXPECT_TRUE(follower.follow(unmasked(turntableView(0.05).frame)).status.ok());
}

TEST(ObjectFollower, RefusesBadOptions)
{
  ObjectFollowerOptions options;
  options.max_turntable_size_m = -1;
  EXPECT_THROW(ObjectFollower{ options }, base::Error);
}

}  // namespace object_modelling::segmentation
