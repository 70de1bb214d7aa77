#include <gtest/gtest.h>

#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "recordings.h"
#include "support/handheld_trajectory.h"
#include "support/temp_dir.h"

namespace object_modelling::pipeline
{
namespace
{
double overlapRatio(const cv::Mat& a, const cv::Mat& b)
{
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}
}  // namespace

// The table's texture stands still: whoever tracks it finds no motion at all.
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
  const SegmentReport segmented = segmentStoredSession(*store, "turn", std::nullopt, {}, control);
  EXPECT_TRUE(segmented.status.ok()) << segmented.status.message;
  EXPECT_EQ(segmented.masked_count, report.keyframe_count);
  EXPECT_TRUE(segmented.support_plane_found);
  const std::vector<rgbd::Keyframe> after = keyframes::loadKeyframes(*store, "turn");
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_EQ(cv::countNonZero(after[i].frame.object_mask != masks[i]), 0);
}

// Round table top that turns with the object on a table that stands still. The object is plain: only the texture of the
// turntable tells how far it has turned.
TEST(ObjectMode, TracksByTheTurntableTooAndKeepsItOutOfTheMasks)
{
  const Recording recording = turntable(40, 2.0);
  test_support::TempDir folder;
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(folder.path("store.db"));
  RecordOptions options;
  options.tracker.reference = tracking::Reference::OBJECT;
  base::JobControl control;
  MemorySource source(recording);
  const RecordReport with = recordSession(source, named("with"), store.get(), options, control);
  EXPECT_EQ(with.trackedRatio(), 1) << with.first_problem;
  const TrajectoryError error = trajectoryError(with.trajectory, recording);
  EXPECT_LT(error.position_m, 0.01);
  EXPECT_LT(error.angle_rad, 0.02);
  for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store, "with"))
  {
    const auto index = std::lround((keyframe.frame.stamp_s - recording.frames[0].stamp_s) * 30);
    EXPECT_GT(overlapRatio(keyframe.frame.object_mask, recording.frames.at(index).object_mask), 0.75) << keyframe.id;
    EXPECT_GT(cv::countNonZero(keyframe.frame.moving_mask), 1.5 * cv::countNonZero(keyframe.frame.object_mask));
  }

  // Earlier recordings do not say what moved; there it is found again.
  keyframes::Session earlier = store->session("with");
  earlier.id = "earlier";
  store->createSession(earlier);
  for (rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store, "with"))
  {
    keyframe.frame.moving_mask.release();
    store->addKeyframe("earlier", keyframe);
  }

  // Bundle adjustment takes the turntable into account again, and leaves the stored masks as they are.
  for (const std::string id : { "with", "earlier" })
  {
    const std::vector<rgbd::Keyframe> before = keyframes::loadKeyframes(*store, id);
    const bundle_adjustment::BundleAdjustmentResult refined = refineStoredSession(*store, id, {}, control);
    ASSERT_TRUE(refined.status.ok()) << id << ": " << refined.status.message;
    const std::vector<rgbd::Keyframe> after = keyframes::loadKeyframes(*store, id);
    EXPECT_EQ(cv::countNonZero(after[0].frame.object_mask), cv::countNonZero(before[0].frame.object_mask)) << id;
    EXPECT_EQ(cv::countNonZero(after[0].frame.moving_mask), cv::countNonZero(before[0].frame.moving_mask)) << id;
    std::vector<source::StampedPose> poses;
    for (const rgbd::Keyframe& keyframe : after)
      poses.push_back({ keyframe.frame.stamp_s, keyframe.T_session_camera });
    EXPECT_LT(trajectoryError(poses, recording).position_m, 0.01) << id;
  }
}

}  // namespace object_modelling::pipeline
