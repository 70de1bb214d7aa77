#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/segmentation/object_mask_propagator.h"
#include "scene_fixtures.h"

namespace object_modelling::segmentation
{
namespace
{
using test_support::standingBox;
using test_support::standingCylinder;

std::vector<rgbd::Keyframe> session(int count, int width = 320)
{
  test_support::SyntheticScene scene;
  scene.objects = { standingBox({ 0.08, 0.12, 0.15 }), standingCylinder(0.06, 0.08, 0.13, 0.02),
                    standingBox({ 0.15, 0.03, 0.03 }, -0.1, -0.12) };
  return test_support::renderKeyframes(scene, test_support::vgaCamera().scaled(width / 640.0),
                                       test_support::orbitPoses(count, { 0, 0, 0.06 }, 0.7, 0.7), kinectNoise());
}

std::vector<rgbd::Keyframe> withoutMasks(std::vector<rgbd::Keyframe> keyframes)
{
  for (rgbd::Keyframe& keyframe : keyframes)
    keyframe.frame.object_mask = cv::Mat();
  return keyframes;
}

}  // namespace

TEST(SegmentSession, ChoosesTheObjectThatTheCameraGoesRound)
{
  const std::vector<rgbd::Keyframe> keyframes = session(16);
  const SessionMasks result = segmentSession(withoutMasks(keyframes), {});
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_EQ(result.masks.size(), keyframes.size());
  for (std::size_t i = 0; i < keyframes.size(); ++i)
  {
    ASSERT_FALSE(result.masks[i].empty()) << i;
    EXPECT_GT(overlap(result.masks[i], keyframes[i].frame.object_mask, keyframes[i].frame.depth_m), 0.9) << i;
  }
  ASSERT_TRUE(result.support_plane_session);
  EXPECT_GT(result.support_plane_session->normal.z(), std::cos(0.002));
  EXPECT_NEAR(result.support_plane_session->offset_m, 0, 0.0007);
}

TEST(SegmentSession, TakesTheObjectAtTheSeedPoint)
{
  const std::vector<rgbd::Keyframe> keyframes = session(12);
  const SessionMasks result = segmentSession(withoutMasks(keyframes), Eigen::Vector3d(0.13, 0.02, 0.04));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  int seen = 0;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    if (!result.masks[i].empty())  // from the other side the box hides it
    {
      ++seen;
      EXPECT_LT(cv::countNonZero(result.masks[i] & keyframes[i].frame.object_mask), 25) << i;
    }
  EXPECT_GE(seen, 9);
  const SessionMasks nowhere = segmentSession(withoutMasks(keyframes), Eigen::Vector3d(0.5, 0.5, 0.3));
  EXPECT_EQ(nowhere.status.code, base::StatusCode::NO_RESULT);
}

TEST(SegmentSession, KeepsGivenMasksAndFindsTheSupport)
{
  const std::vector<rgbd::Keyframe> keyframes = session(8, 640);
  const SessionMasks result = segmentSession(keyframes, {});
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    EXPECT_EQ(result.masks[i].data, keyframes[i].frame.object_mask.data);
  ASSERT_TRUE(result.support_plane_session);
  EXPECT_GT(result.support_plane_session->normal.z(), std::cos(0.003));
  EXPECT_NEAR(result.support_plane_session->offset_m, 0, 0.001);
}

TEST(SegmentSession, FillsInMasksWhereSomeAreMissing)
{
  std::vector<rgbd::Keyframe> keyframes = session(12);
  const cv::Mat truth = keyframes[5].frame.object_mask;
  keyframes[5].frame.object_mask = cv::Mat();
  const SessionMasks result = segmentSession(keyframes, {});
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.masks[4].data, keyframes[4].frame.object_mask.data);
  EXPECT_GT(overlap(result.masks[5], truth, keyframes[5].frame.depth_m), 0.9);
}

TEST(SegmentSession, RefusesMasksOfAnotherSizeAndEmptySessions)
{
  std::vector<rgbd::Keyframe> keyframes = session(3);
  keyframes[1].frame.object_mask = cv::Mat::zeros(10, 10, CV_8UC1);
  const SessionMasks result = segmentSession(keyframes, {});
  EXPECT_EQ(result.status.code, base::StatusCode::BAD_INPUT);
  EXPECT_NE(result.status.message.find("keyframe 1"), std::string::npos);
  EXPECT_EQ(segmentSession({}, {}).status.code, base::StatusCode::FAILED_PRECONDITION);
}

TEST(SegmentSession, SaysThatNoKeyframeShowsAnObject)
{
  const std::vector<rgbd::Keyframe> keyframes =
      withoutMasks(test_support::renderKeyframes({}, smallCamera(), test_support::orbitPoses(3), kinectNoise()));
  const SessionMasks result = segmentSession(keyframes, {});
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(result.status.message.find("no hypothesis"), std::string::npos) << result.status.message;
  EXPECT_EQ(result.masks.size(), 3U);
}

TEST(SegmentSession, IsDeterministic)
{
  const std::vector<rgbd::Keyframe> keyframes = withoutMasks(session(6));
  const SessionMasks a = segmentSession(keyframes, {}), b = segmentSession(keyframes, {});
  ASSERT_TRUE(a.status.ok());
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    EXPECT_EQ(cv::countNonZero(a.masks[i] != b.masks[i]), 0) << i;
  EXPECT_EQ(a.support_plane_session->normal, b.support_plane_session->normal);
}

}  // namespace object_modelling::segmentation
