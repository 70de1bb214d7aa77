#include <gtest/gtest.h>

#include "object_modelling/pipeline/record_session.h"
#include "recordings.h"
#include "support/temp_dir.h"
#include "support/transform_matchers.h"

namespace object_modelling::pipeline
{
using base::StatusCode;
using ::testing::Test;

namespace
{
constexpr int FRAME_COUNT = 24;
constexpr double WALK_RAD = 1.2;

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}
}  // namespace

class RecordSession : public Test
{
protected:
  RecordReport record(const MemorySource::Spoil& spoil = {}, const RecordOptions& options = {})
  {
    MemorySource source(recording_, spoil);
    base::JobControl control;
    return recordSession(source, named("walk"), store_.get(), options, control);
  }

  const Recording& recording_ = walkRoundBox(FRAME_COUNT, WALK_RAD);
  test_support::TempDir folder_;
  std::unique_ptr<keyframes::SessionStore> store_ = keyframes::openSqlStore(folder_.path("store.db"));
};

TEST_F(RecordSession, StoresTheKeyframesAndFollowsTheTruth)
{
  const RecordReport report = record();
  EXPECT_EQ(report.session_id, "walk");
  EXPECT_EQ(report.frame_count, FRAME_COUNT);
  EXPECT_EQ(report.tracked_count, FRAME_COUNT);
  EXPECT_EQ(report.unusable_count, 0);
  EXPECT_EQ(report.lost_count, 0);
  EXPECT_EQ(report.relocalised_count, 0);
  EXPECT_EQ(report.first_problem, "");
  EXPECT_EQ(report.trackedRatio(), 1.0);
  EXPECT_EQ(report.track_ms.size(), std::size_t(FRAME_COUNT));
  ASSERT_EQ(report.trajectory.size(), std::size_t(FRAME_COUNT));

  const TrajectoryError error = trajectoryError(report.trajectory, recording_);
  EXPECT_LT(error.position_m, 0.003);
  EXPECT_LT(error.angle_rad, 0.005);

  const keyframes::Session session = store_->session("walk");
  EXPECT_TRUE(session.closed);
  EXPECT_FALSE(session.reference_is_object);
  EXPECT_EQ(session.camera_frame_id, "camera_optical");
  EXPECT_EQ(session.keyframe_count, report.keyframe_count);
  EXPECT_DOUBLE_EQ(session.started_s, recording_.frames[0].stamp_s);
  // 1.2 rad in steps of 12 degrees
  EXPECT_GE(report.keyframe_count, 4);
  EXPECT_LT(report.keyframe_count, FRAME_COUNT);

  const std::vector<rgbd::Keyframe> stored = keyframes::loadKeyframes(*store_, "walk");
  ASSERT_EQ(stored.size(), std::size_t(report.keyframe_count));
  EXPECT_TRANSFORM_NEAR(stored[0].T_session_camera, Eigen::Isometry3d::Identity(), 1e-12, 1e-7);
  for (const rgbd::Keyframe& keyframe : stored)
  {
    EXPECT_GT(keyframe.observations.size(), 20u) << "keyframe " << keyframe.id;
    EXPECT_TRUE(keyframe.frame.object_mask.empty());
  }
}

TEST_F(RecordSession, MakesTheTrajectoryAloneWithoutAStoreAndTheSameOneAgain)
{
  const RecordReport stored = record();
  MemorySource source(recording_);
  base::JobControl control;
  const RecordReport unstored = recordSession(source, named("walk"), nullptr, {}, control);
  ASSERT_EQ(unstored.trajectory.size(), stored.trajectory.size());
  for (std::size_t i = 0; i < stored.trajectory.size(); ++i)
    EXPECT_EQ(unstored.trajectory[i].T_map_camera.matrix(), stored.trajectory[i].T_map_camera.matrix()) << i;
}

TEST_F(RecordSession, ReportsProgressAndLeavesNoSessionWhenCancelled)
{
  int calls = 0;
  std::size_t keyframes_before = 0;
  base::JobControl* hand = nullptr;
  base::JobControl control(
      [&](const base::Progress& progress)
      {
        EXPECT_EQ(progress.stage, "track");
        EXPECT_EQ(progress.done, std::size_t(calls++));
        EXPECT_EQ(progress.total, std::size_t(FRAME_COUNT));
        if (progress.done == FRAME_COUNT / 2)
        {
          keyframes_before = store_->keyframeIds("walk").size();
          hand->cancel();
        }
      });
  hand = &control;
  MemorySource source(recording_);
  EXPECT_THROW(recordSession(source, named("walk"), store_.get(), {}, control), base::Cancelled);
  EXPECT_GT(keyframes_before, 1u);
  EXPECT_TRUE(store_->listSessions().empty());
}

TEST_F(RecordSession, LeavesNoSessionWhenTheRecordingBreaksOff)
{
  const base::Status status = statusOf(
      [this]
      {
        record(
            [](int index, rgbd::RawFrame*)
            {
              if (index == 10)
                throw base::Error(StatusCode::BAD_INPUT, "frame 10 cannot be decoded");
            });
      });
  EXPECT_EQ(status.code, StatusCode::BAD_INPUT);
  EXPECT_EQ(status.message, "frame 10 cannot be decoded");
  EXPECT_TRUE(store_->listSessions().empty());
}

TEST_F(RecordSession, RefusesARecordingWithoutFrames)
{
  const Recording nothing;
  MemorySource source(nothing);
  base::JobControl control;
  const base::Status status = statusOf([&] { recordSession(source, named("walk"), store_.get(), {}, control); });
  EXPECT_EQ(status.code, StatusCode::BAD_INPUT);
  EXPECT_EQ(status.message, "recording 'synthetic recording': has no frames");
  EXPECT_TRUE(store_->listSessions().empty());
}

TEST_F(RecordSession, RefusesARecordingWithoutDepth)
{
  const base::Status status = statusOf([this] { record([](int, rgbd::RawFrame* raw) { removeDepth(raw); }); });
  EXPECT_EQ(status.code, StatusCode::BAD_INPUT);
  EXPECT_TRUE(contains(status.message, "24 of 24 frames are unusable; first problem: frame 0 unusable: "))
      << status.message;
  EXPECT_TRUE(store_->listSessions().empty());
}

TEST_F(RecordSession, RefusesARecordingThatShowsNothingToTrack)
{
  const base::Status status = statusOf(
      [this] {
        record([](int, rgbd::RawFrame* raw)
               { raw->color = cv::Mat(raw->color.size(), CV_8UC3, cv::Scalar::all(128)); });
      });
  EXPECT_EQ(status.code, StatusCode::BAD_INPUT);
  EXPECT_TRUE(contains(status.message, "no frame could be tracked; first problem: frame 0 not tracked: "))
      << status.message;
  EXPECT_TRUE(store_->listSessions().empty());
}

TEST_F(RecordSession, BridgesFramesWithoutDepthUpToTheAllowedShare)
{
  const auto everySecond = [](int index, rgbd::RawFrame* raw)
  {
    if (index % 2 == 1)
      removeDepth(raw);
  };
  RecordOptions strict;
  strict.max_unusable_ratio = 0.49;
  const base::Status refused = statusOf([&] { record(everySecond, strict); });
  EXPECT_EQ(refused.code, StatusCode::BAD_INPUT);
  EXPECT_TRUE(contains(refused.message, "12 of 24 frames are unusable")) << refused.message;
  EXPECT_TRUE(store_->listSessions().empty());

  const RecordReport report = record(everySecond);
  EXPECT_EQ(report.frame_count, FRAME_COUNT);
  EXPECT_EQ(report.unusable_count, FRAME_COUNT / 2);
  EXPECT_EQ(report.tracked_count, FRAME_COUNT / 2);
  EXPECT_EQ(report.trackedRatio(), 0.5);
  EXPECT_TRUE(contains(report.first_problem, "frame 1 unusable: ")) << report.first_problem;
  EXPECT_LT(trajectoryError(report.trajectory, recording_).position_m, 0.005);
  EXPECT_TRUE(store_->session("walk").closed);
}

TEST_F(RecordSession, LeavesASessionOfThatNameUntouched)
{
  record();
  const std::string before = fingerprint(*store_, "walk");
  const base::Status status = statusOf([this] { record(); });
  EXPECT_EQ(status.code, StatusCode::FAILED_PRECONDITION);
  EXPECT_TRUE(contains(status.message, "'walk'")) << status.message;
  EXPECT_EQ(fingerprint(*store_, "walk"), before);
  EXPECT_EQ(store_->listSessions().size(), 1u);
}

TEST_F(RecordSession, RefusesHostileNamesAndOptions)
{
  base::JobControl control;
  for (const std::string id : { "", "../walk", "a b", "-walk", "'; DROP TABLE sessions" })
  {
    MemorySource source(recording_);
    EXPECT_EQ(statusOf([&] { recordSession(source, named(id), store_.get(), {}, control); }).code,
              StatusCode::INVALID_ARGUMENT)
        << id;
  }
  RecordOptions options;
  options.max_unusable_ratio = 1.5;
  options.tracker.max_features = 0;
  const base::Status status = statusOf([&] { record({}, options); });
  EXPECT_EQ(status.code, StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(contains(status.message, "max_unusable_ratio")) << status.message;
  EXPECT_TRUE(contains(status.message, "max_features")) << status.message;
  EXPECT_TRUE(store_->listSessions().empty());
}

}  // namespace object_modelling::pipeline
