#include "object_modelling/segmentation/object_mask_propagator.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene_fixtures.h"
#include "support/violations.h"

namespace object_modelling::segmentation
{
namespace
{
using test_support::standingBox;

/// A box with a neighbour 3 cm beside it, seen from round about.
test_support::SyntheticScene boxBesideBox()
{
  test_support::SyntheticScene scene;
  scene.objects = { standingBox({ 0.08, 0.12, 0.15 }), standingBox({ 0.08, 0.1, 0.1 }, 0.11, 0, 0, 9) };
  return scene;
}

rgbd::Keyframe withoutMask(rgbd::Keyframe keyframe)
{
  keyframe.frame.object_mask = cv::Mat();
  return keyframe;
}

std::vector<rgbd::Keyframe> orbit(const test_support::SyntheticScene& scene, int count)
{
  return test_support::renderKeyframes(scene, test_support::vgaCamera(),
                                       test_support::orbitPoses(count, { 0, 0, 0.06 }, 0.75, 0.7), kinectNoise());
}

base::Status startAt(ObjectMaskPropagator* propagator, const rgbd::Keyframe& keyframe)
{
  const SceneSegmentation segmentation = SceneSegmenter().segment(keyframe.frame);
  const base::Result<int> chosen =
      selectByPoint(segmentation, keyframe.T_session_camera.inverse() * Eigen::Vector3d(0, 0, 0.07));
  return chosen.ok() ? propagator->start(keyframe, segmentation, chosen.value) : chosen.status;
}

}  // namespace

TEST(ObjectMaskPropagator, FollowsTheObjectRoundAndLeavesItsNeighbor)
{
  const std::vector<rgbd::Keyframe> keyframes = orbit(boxBesideBox(), 18);
  ObjectMaskPropagator propagator;
  ASSERT_TRUE(startAt(&propagator, withoutMask(keyframes[0])).ok());
  for (const rgbd::Keyframe& keyframe : keyframes)
  {
    const base::Result<cv::Mat> mask = propagator.propagate(withoutMask(keyframe));
    ASSERT_TRUE(mask.ok()) << keyframe.id << ": " << mask.status.message;
    EXPECT_GT(overlap(mask.value, keyframe.frame.object_mask, keyframe.frame.depth_m), 0.9) << keyframe.id;
  }
  ASSERT_TRUE(propagator.supportPlane());
  EXPECT_GT(propagator.supportPlane()->normal.z(), std::cos(0.001));
  EXPECT_NEAR(propagator.supportPlane()->offset_m, 0, 0.0005);
}

TEST(ObjectMaskPropagator, WorksWhereTheObjectIsCutOffByTheImage)
{
  const std::vector<rgbd::Keyframe> keyframes = orbit(boxBesideBox(), 18);
  ObjectMaskPropagator propagator;
  ASSERT_TRUE(startAt(&propagator, withoutMask(keyframes[0])).ok());
  for (const rgbd::Keyframe& keyframe : keyframes)
    propagator.propagate(withoutMask(keyframe));
  rgbd::Keyframe beside =
      test_support::renderKeyframes(boxBesideBox(), test_support::vgaCamera(),
                                    { test_support::lookAt({ -0.1, -0.7, 0.5 }, { -0.47, 0, 0 }) }, kinectNoise())
          .front();
  const int seen = cv::countNonZero(beside.frame.object_mask);
  ASSERT_GT(cv::countNonZero(beside.frame.object_mask.col(639)), 0) << "meant to touch the border; " << seen << " px";
  const base::Result<cv::Mat> mask = propagator.propagate(withoutMask(beside));
  ASSERT_TRUE(mask.ok()) << mask.status.message;
  EXPECT_GT(overlap(mask.value, beside.frame.object_mask, beside.frame.depth_m), 0.9);
}

TEST(ObjectMaskPropagator, AsksForAStartAndForAHypothesisThatExists)
{
  const rgbd::Keyframe keyframe = withoutMask(orbit(boxBesideBox(), 4).front());
  ObjectMaskPropagator propagator;
  EXPECT_FALSE(propagator.started());
  EXPECT_FALSE(propagator.supportPlane());
  EXPECT_EQ(propagator.propagate(keyframe).status.code, base::StatusCode::FAILED_PRECONDITION);
  const SceneSegmentation segmentation = SceneSegmenter().segment(keyframe.frame);
  EXPECT_EQ(propagator.start(keyframe, segmentation, 99).code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(propagator.start(keyframe, segmentation, -1).code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(propagator.start(keyframe, SceneSegmentation{}, 0).code, base::StatusCode::FAILED_PRECONDITION);
  rgbd::Keyframe smaller = keyframe;
  smaller.frame.depth_m = cv::Mat::ones(240, 320, CV_32FC1);
  EXPECT_EQ(propagator.start(smaller, segmentation, 0).code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_FALSE(propagator.started());
}

TEST(ObjectMaskPropagator, SaysThatTheObjectIsNotInView)
{
  const std::vector<rgbd::Keyframe> keyframes = orbit(boxBesideBox(), 4);
  ObjectMaskPropagator propagator;
  ASSERT_TRUE(startAt(&propagator, withoutMask(keyframes[0])).ok());
  rgbd::Keyframe away = withoutMask(keyframes[0]);
  away.T_session_camera = test_support::lookAt({ 0, -0.7, 0.5 }, { 0, -3, 0 });
  EXPECT_EQ(propagator.propagate(away).status.code, base::StatusCode::NO_RESULT);
  rgbd::Keyframe covered = withoutMask(keyframes[0]);
  covered.frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(std::nanf("")));
  EXPECT_EQ(propagator.propagate(covered).status.code, base::StatusCode::NO_RESULT);
}

TEST(ObjectMaskPropagator, NamesBrokenOptionsOfTheSegmenterToo)
{
  ObjectMaskPropagatorOptions options;
  options.voxel_size_m = 0;
  options.segmenter.min_cluster_px = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "min_cluster_px", "voxel_size_m" }));
  EXPECT_THROW(ObjectMaskPropagator{ options }, base::Error);
}

}  // namespace object_modelling::segmentation
