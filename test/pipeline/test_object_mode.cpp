#include <gtest/gtest.h>

#include "object_modelling/pipeline/object_follower.h"
#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "recordings.h"
#include "support/handheld_trajectory.h"
#include "support/temp_dir.h"

namespace object_modelling::pipeline
{
using base::StatusCode;

namespace
{
double overlapRatio(const cv::Mat& a, const cv::Mat& b)
{
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

rgbd::Frame withoutMask(rgbd::Frame frame)
{
  frame.object_mask.release();
  return frame;
}
}  // namespace

// The table's print stands still: whoever tracks it finds no motion at all.
TEST(ObjectMode, FollowsATurningObjectBySegmentation)
{
  const Recording recording = turningBox(30, 1.2);
  test_support::TempDir folder;
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(folder.path("store.db"));
  RecordOptions options;
  options.tracker.reference = tracking::Reference::OBJECT;
  MemorySource source(recording);
  base::JobControl control;
  const RecordReport report = recordSession(source, named("turn"), store.get(), options, control);
  EXPECT_GE(report.trackedRatio(), 0.95) << report.first_problem;
  const TrajectoryError error = trajectoryError(report.trajectory, recording);
  EXPECT_LT(error.position_m, 0.02);
  EXPECT_LT(error.angle_rad, 0.04);
  EXPECT_TRUE(store->session("turn").reference_is_object);
  EXPECT_GE(report.keyframe_count, 4);

  std::vector<cv::Mat> masks;
  for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store, "turn"))
  {
    const auto index = std::lround((keyframe.frame.stamp_s - recording.frames[0].stamp_s) * 30);
    ASSERT_FALSE(keyframe.frame.object_mask.empty());
    EXPECT_GT(overlapRatio(keyframe.frame.object_mask, recording.frames.at(index).object_mask), 0.75) << keyframe.id;
    masks.push_back(keyframe.frame.object_mask);
  }

  // These masks are measurements: the stages after it keep them.
  const SegmentReport segmented = segmentSession(*store, "turn", std::nullopt, {}, control);
  EXPECT_TRUE(segmented.status.ok()) << segmented.status.message;
  EXPECT_EQ(segmented.masked_count, report.keyframe_count);
  EXPECT_TRUE(segmented.support_plane_found);
  const std::vector<rgbd::Keyframe> after = keyframes::loadKeyframes(*store, "turn");
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_EQ(cv::countNonZero(after[i].frame.object_mask != masks[i]), 0);
}

TEST(ObjectMode, KeepsTheMasksThatAFrameBrings)
{
  ObjectFollower follower({});
  rgbd::Frame frame = walkRoundBox(24, 1.2).frames[0];
  const cv::Mat before = frame.object_mask.clone();
  EXPECT_TRUE(follower.follow(&frame).ok());
  EXPECT_EQ(cv::countNonZero(before != frame.object_mask), 0);
}

TEST(ObjectMode, StaysWithTheObjectItHasAndSaysWhenItIsGone)
{
  test_support::SyntheticScene scene;
  scene.objects = { test_support::standingBox({ 0.08, 0.08, 0.12 }, -0.12, 0),
                    test_support::standingBox({ 0.08, 0.08, 0.12 }, 0.12, 0, 0, 9) };
  const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0.05 }, 0.6, -M_PI / 2, 0.6);
  const test_support::SceneImage both = test_support::renderScene(scene, smallCamera(), T_world_camera);
  const auto maskOf = [&both](int instance) { return cv::Mat(both.instances == instance); };
  for (const int wanted : { 1, 2 })
  {
    ObjectFollower follower({});
    rgbd::Frame first = both.frame;
    first.object_mask = maskOf(wanted);
    ASSERT_TRUE(follower.follow(&first).ok());
    rgbd::Frame second = withoutMask(both.frame);
    ASSERT_TRUE(follower.follow(&second).ok());
    EXPECT_GT(overlapRatio(second.object_mask, maskOf(wanted)), 0.75) << wanted;
  }

  ObjectFollower follower({});
  rgbd::Frame first = both.frame;
  ASSERT_TRUE(follower.follow(&first).ok());
  scene.objects.erase(scene.objects.begin());
  rgbd::Frame alone = withoutMask(test_support::renderFrame(scene, smallCamera(), T_world_camera));
  const base::Status gone = follower.follow(&alone);
  EXPECT_EQ(gone.code, StatusCode::NO_RESULT);
  EXPECT_NE(gone.message.find("left the view or was covered"), std::string::npos) << gone.message;
  EXPECT_TRUE(alone.object_mask.empty());
}

TEST(ObjectMode, FindsNothingOnAnEmptyTable)
{
  ObjectFollower follower({});
  rgbd::Frame frame = withoutMask(test_support::renderFrame(test_support::SyntheticScene(), smallCamera(),
                                                            test_support::orbitPose({ 0, 0, 0 }, 0.6, 0, 0.6)));
  EXPECT_EQ(follower.follow(&frame).code, StatusCode::NO_RESULT);
  EXPECT_TRUE(frame.object_mask.empty());
}

}  // namespace object_modelling::pipeline
