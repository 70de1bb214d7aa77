#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "object_modelling/pipeline/session_recorder.h"
#include "recordings.h"
#include "support/temp_dir.h"

namespace object_modelling::pipeline
{
using base::StatusCode;
using tracking::TrackingStatus;

namespace
{
constexpr char CAMERA[] = "camera_optical";

/// A store that can be made to fail.
class UnreliableSink : public StoreSink
{
public:
  using StoreSink::StoreSink;

  void create(const keyframes::Session& session) override
  {
    check();
    StoreSink::create(session);
  }
  void add(const std::string& session_id, const rgbd::Keyframe& keyframe, const std::string& camera_frame_id) override
  {
    check();
    StoreSink::add(session_id, keyframe, camera_frame_id);
  }
  void close(const std::string& session_id, int keyframe_count) override
  {
    check();
    closed_with = keyframe_count;
    StoreSink::close(session_id, keyframe_count);
  }

  bool fails = false;
  int closed_with = -1;

private:
  void check() const
  {
    if (fails)
      throw base::Error(StatusCode::STORAGE, "disk full");
  }
};

/// A store whose keyframes have lost their images.
class ImagelessSink : public StoreSink
{
public:
  using StoreSink::StoreSink;
  std::vector<rgbd::Keyframe> stored(const std::string& session_id, const rgbd::SensorNoiseModel& noise_model) override
  {
    std::vector<rgbd::Keyframe> keyframes = StoreSink::stored(session_id, noise_model);
    keyframes.front().frame.gray.release();
    keyframes.front().frame.depth_m.release();
    return keyframes;
  }
};

SessionRecorderOptions onObject()
{
  SessionRecorderOptions options;
  options.tracker.reference = tracking::Reference::OBJECT;
  return options;
}

rgbd::Frame withoutMask(rgbd::Frame frame)
{
  frame.object_mask.release();
  return frame;
}

/// As with a hand before the lens.
rgbd::Frame covered(rgbd::Frame frame)
{
  frame.color_bgr = cv::Mat(frame.color_bgr.size(), CV_8UC3, cv::Scalar::all(20));
  frame.gray = cv::Mat(frame.gray.size(), CV_8UC1, cv::Scalar(20));
  frame.depth_m = cv::Mat(frame.depth_m.size(), CV_32FC1, cv::Scalar(0.15));
  return frame;
}
}  // namespace

class Recorder : public ::testing::Test
{
protected:
  RecordedFrame process(SessionRecorder& recorder, int index)
  {
    return recorder.process(recording_.frames.at(index), CAMERA);
  }
  void process(SessionRecorder& recorder, int begin, int end)
  {
    for (int i = begin; i < end; ++i)
    {
      const RecordedFrame recorded = process(recorder, i);
      EXPECT_TRUE(recorded.result.tracked()) << i << ": " << recorded.result.reason;
    }
  }
  /// Stores frames 0 to 7 as a session of this id.
  void recordStart(const std::string& id)
  {
    SessionRecorder recorder({}, &sink_);
    recorder.start(named(id));
    process(recorder, 0, 8);
    recorder.finish();
  }

  const Recording& recording_ = walkRoundBox(24, 1.2);
  test_support::TempDir folder_;
  std::unique_ptr<keyframes::SessionStore> store_ = keyframes::openSqlStore(folder_.path("store.db"));
  UnreliableSink sink_{ *store_ };
};

TEST_F(Recorder, RefusesCallsInTheWrongOrder)
{
  SessionRecorder recorder({}, &sink_);
  recorder.reset();
  for (int round = 0; round < 2; ++round)
  {
    EXPECT_EQ(statusOf([&] { process(recorder, 0); }).code, StatusCode::FAILED_PRECONDITION);
    EXPECT_EQ(statusOf([&] { recorder.finish(); }).code, StatusCode::FAILED_PRECONDITION);
    EXPECT_EQ(statusOf([&] { recorder.end(); }).code, StatusCode::FAILED_PRECONDITION);

    const std::string id = "walk" + std::to_string(round);
    recorder.start(named(id));
    for (const base::Status& status :
         { statusOf([&] { recorder.start(named("other")); }), statusOf([&] { recorder.resume("other"); }) })
    {
      EXPECT_EQ(status.code, StatusCode::FAILED_PRECONDITION);
      EXPECT_EQ(status.message, "session '" + id + "' is being recorded; finish it first");
    }
    EXPECT_TRUE(recorder.recording());
    process(recorder, 0, 3);
    recorder.finish();
    EXPECT_FALSE(recorder.recording());
  }
  EXPECT_EQ(store_->listSessions().size(), 2u);
}

TEST_F(Recorder, CommitsTheRecordWithTheFirstFrameAndKeyframesAsTheyCome)
{
  SessionRecorderOptions options;
  options.noise_model.axial_constant_m = 0.002;
  SessionRecorder recorder(options, &sink_);
  keyframes::Session session = named("walk");
  session.object_id = "box";
  recorder.start(session);
  EXPECT_TRUE(store_->listSessions().empty());
  for (int i = 0; i < 24; ++i)
  {
    process(recorder, i, i + 1);
    EXPECT_EQ(store_->session("walk").keyframe_count, recorder.counts().keyframe_count);
  }
  session = store_->session("walk");
  EXPECT_FALSE(session.closed || session.reference_is_object);
  EXPECT_EQ(session.object_id, "box");
  EXPECT_EQ(session.camera_frame_id, CAMERA);
  EXPECT_DOUBLE_EQ(session.started_s, recording_.frames[0].stamp_s);
  EXPECT_TRUE(session.calibration.noise_model == options.noise_model);
  EXPECT_EQ(recorder.counts().frame_count, 24);
  EXPECT_EQ(recorder.counts().tracked_count, 24);
  EXPECT_GE(recorder.counts().keyframe_count, 4);

  recorder.finish();
  EXPECT_TRUE(store_->session("walk").closed);
  EXPECT_EQ(sink_.closed_with, session.keyframe_count);
  // What the last session was can be asked for until the next one.
  EXPECT_EQ(recorder.session().id, "walk");
  EXPECT_EQ(recorder.counts().frame_count, 24);
  recorder.start(named("next"));
  EXPECT_EQ(recorder.counts().frame_count, 0);
}

TEST_F(Recorder, CreatesASessionAtOnceWhereTheCameraIsKnown)
{
  keyframes::Session session = named("walk");
  session.camera_frame_id = CAMERA;
  SessionRecorder recorder({}, &sink_);
  recorder.start(session);
  EXPECT_EQ(store_->session("walk").camera_frame_id, CAMERA);
  recorder.finish();
  EXPECT_TRUE(store_->session("walk").closed);
  EXPECT_EQ(statusOf([&] { recorder.start(session); }).code, StatusCode::FAILED_PRECONDITION);
  EXPECT_FALSE(recorder.recording());
  EXPECT_TRUE(store_->session("walk").closed);
}

TEST_F(Recorder, EndsASessionWithoutFramesWithoutATrace)
{
  SessionRecorder recorder({}, &sink_);
  recorder.start(named("walk"));
  recorder.finish();
  EXPECT_TRUE(store_->listSessions().empty());
}

TEST_F(Recorder, ResumesAStoredSession)
{
  recordStart("walk");
  const int before = store_->session("walk").keyframe_count;
  keyframes::SessionChange change;
  change.refined = change.segmented = keyframes::StageMark{ "unknown", "" };
  change.support_plane_session = geometry::Plane{ Eigen::Vector3d::UnitZ(), 0 };
  store_->update("walk", change);

  SessionRecorder recorder({}, &sink_);
  recorder.resume("walk");
  EXPECT_EQ(recorder.counts().keyframe_count, before);
  keyframes::Session session = store_->session("walk");
  EXPECT_FALSE(session.closed || session.refined.done() || session.segmented.done() || session.support_plane_session);
  // A new camera, with a clock of its own.
  EXPECT_EQ(process(recorder, 4).result.status, TrackingStatus::RELOCALISED);
  process(recorder, 5, 24);
  EXPECT_EQ(recorder.counts().relocalised_count, 1);
  EXPECT_EQ(recorder.counts().frame_count, 20);
  recorder.finish();
  session = store_->session("walk");
  EXPECT_TRUE(session.closed);
  EXPECT_EQ(session.keyframe_count, recorder.counts().keyframe_count);
  EXPECT_GT(session.keyframe_count, before);
  EXPECT_EQ(session.camera_frame_id, CAMERA);
}

TEST_F(Recorder, RefusesToResumeWhatItCannotContinue)
{
  recordStart("walk");
  store_->createSession(named("empty"));
  const std::string before = fingerprint(*store_, "walk");
  SessionRecorder recorder({}, &sink_);
  EXPECT_EQ(statusOf([&] { recorder.resume("nobody"); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(statusOf([&] { recorder.resume("empty"); }).code, StatusCode::NO_RESULT);
  SessionRecorderOptions other;
  other.noise_model.axial_constant_m = 0.002;
  SessionRecorder with_other(other, &sink_);
  EXPECT_EQ(statusOf([&] { with_other.resume("walk"); }).code, StatusCode::FAILED_PRECONDITION);
  SessionRecorder unkept({}, nullptr);
  EXPECT_EQ(statusOf([&] { unkept.resume("walk"); }).code, StatusCode::INVALID_ARGUMENT);
  ImagelessSink imageless(*store_);
  SessionRecorder without_images({}, &imageless);
  EXPECT_EQ(statusOf([&] { without_images.resume("walk"); }).code, StatusCode::BAD_INPUT);
  EXPECT_FALSE(recorder.recording() || with_other.recording() || unkept.recording() || without_images.recording());
  EXPECT_EQ(fingerprint(*store_, "walk"), before);
}

TEST_F(Recorder, CountsLossesAndRecoveries)
{
  SessionRecorder recorder({}, &sink_);
  recorder.start(named("walk"));
  process(recorder, 0, 8);
  for (int i = 8; i < 11; ++i)
    EXPECT_EQ(recorder.process(covered(recording_.frames[i]), CAMERA).result.status, TrackingStatus::LOST);
  EXPECT_EQ(process(recorder, 11).result.status, TrackingStatus::RELOCALISED);
  process(recorder, 12, 14);
  EXPECT_EQ(recorder.counts().frame_count, 14);
  EXPECT_EQ(recorder.counts().tracked_count, 11);
  EXPECT_EQ(recorder.counts().lost_count, 1);
  EXPECT_EQ(recorder.counts().relocalised_count, 1);
}

TEST_F(Recorder, RefusesFramesThatAreNotNewer)
{
  SessionRecorder recorder({}, &sink_), undisturbed({}, nullptr);
  recorder.start(named("walk"));
  undisturbed.start(named("walk"));
  process(recorder, 0, 6);
  process(undisturbed, 0, 6);
  const int keyframe_count = recorder.counts().keyframe_count;
  for (const int index : { 5, 0 })
  {
    const RecordedFrame refused = process(recorder, index);
    EXPECT_EQ(refused.result.status, TrackingStatus::LOST);
    EXPECT_EQ(refused.newest_stamp_s, recording_.frames[5].stamp_s);
    EXPECT_NE(refused.result.reason.find("is not newer than that of the last frame"), std::string::npos);
  }
  EXPECT_EQ(recorder.counts().frame_count, 8);
  EXPECT_EQ(recorder.counts().lost_count, 1);
  EXPECT_EQ(recorder.counts().keyframe_count, keyframe_count);
  EXPECT_EQ(process(recorder, 6).result.T_session_camera.matrix(),
            process(undisturbed, 6).result.T_session_camera.matrix());
  // A new session may be of an earlier time.
  recorder.finish();
  recorder.start(named("again"));
  process(recorder, 0, 2);
}

TEST_F(Recorder, GoesOnWhenTheStoreFails)
{
  SessionRecorder recorder({}, &sink_);
  recorder.start(named("walk"));
  sink_.fails = true;
  EXPECT_EQ(statusOf([&] { process(recorder, 0); }).code, StatusCode::STORAGE);
  EXPECT_EQ(recorder.counts().frame_count, 0);
  sink_.fails = false;
  process(recorder, 1, 3);
  EXPECT_DOUBLE_EQ(store_->session("walk").started_s, recording_.frames[1].stamp_s);
  EXPECT_EQ(store_->keyframeIds("walk"), std::vector<int>({ 0 }));

  sink_.fails = true;
  int failed = 0;
  int next = 3;
  for (; failed == 0 && next < 24; ++next)
    failed += !statusOf([&] { process(recorder, next); }).ok();
  EXPECT_EQ(failed, 1);
  EXPECT_EQ(recorder.counts().keyframe_count, 1);
  EXPECT_EQ(statusOf([&] { recorder.finish(); }).code, StatusCode::STORAGE);
  EXPECT_TRUE(recorder.recording());

  sink_.fails = false;
  process(recorder, next, 24);
  recorder.finish();
  EXPECT_TRUE(store_->session("walk").closed);
  EXPECT_EQ(sink_.closed_with, store_->session("walk").keyframe_count);
  EXPECT_GE(sink_.closed_with, 2);
}

TEST_F(Recorder, LeavesNothingOfASessionThatIsReset)
{
  SessionRecorder recorder({}, &sink_);
  recorder.start(named("walk"));
  process(recorder, 0, 3);
  EXPECT_EQ(store_->listSessions().size(), 1u);
  recorder.reset();
  EXPECT_TRUE(store_->listSessions().empty());
  EXPECT_FALSE(recorder.recording());
  EXPECT_EQ(recorder.session().id, "");
  EXPECT_EQ(recorder.counts().frame_count, 0);
  recordStart("walk");

  // What was there before stays.
  recorder.resume("walk");
  process(recorder, 4, 6);
  recorder.reset();
  EXPECT_FALSE(store_->session("walk").closed);
  EXPECT_GE(store_->session("walk").keyframe_count, 1);
}

TEST_F(Recorder, FollowsTheObjectItselfAndWaitsUntilItSeesOne)
{
  const Recording recording = turntable(12, 0.6);
  SessionRecorder recorder(onObject(), &sink_);
  recorder.start(named("turn"));
  const rgbd::Frame hidden = covered(withoutMask(recording.frames[0]));
  const RecordedFrame without = recorder.process(hidden, CAMERA);
  EXPECT_EQ(without.object.code, StatusCode::NO_RESULT) << without.object.message;
  EXPECT_EQ(without.result.status, TrackingStatus::NOT_STARTED);
  EXPECT_TRUE(without.frame.object_mask.empty());
  for (std::size_t i = 1; i < recording.frames.size(); ++i)
  {
    const RecordedFrame recorded = recorder.process(withoutMask(recording.frames[i]), CAMERA);
    EXPECT_TRUE(recorded.result.tracked()) << i << ": " << recorded.result.reason;
    if (!recorded.result.keyframe)
      continue;
    // Tracked by the turntable too, which is no part of the object.
    const rgbd::Frame& kept = recorded.result.keyframe->frame;
    EXPECT_EQ(cv::countNonZero(kept.object_mask & ~kept.moving_mask), 0);
    EXPECT_GT(cv::countNonZero(kept.moving_mask), 1.5 * cv::countNonZero(kept.object_mask));
  }
  EXPECT_EQ(recorder.counts().tracked_count, 11);
  recorder.finish();
  EXPECT_TRUE(store_->session("turn").reference_is_object);
  EXPECT_EQ(store_->session("turn").keyframe_count, recorder.counts().keyframe_count);
}

TEST_F(Recorder, ChecksItsOptions)
{
  SessionRecorderOptions options;
  options.tracker.max_features = 0;
  options.follower.max_turntable_size_m = -1;
  const base::Status status = statusOf([&] { SessionRecorder recorder(options, nullptr); });
  EXPECT_EQ(status.code, StatusCode::INVALID_ARGUMENT);
  EXPECT_NE(status.message.find("max_features"), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("max_turntable_size_m"), std::string::npos) << status.message;
}

}  // namespace object_modelling::pipeline
