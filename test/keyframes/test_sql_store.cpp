#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "every_backend.h"

namespace object_modelling::keyframes
{
using base::StatusCode;

namespace
{
const geometry::Matrix6d NO_COVARIANCE = geometry::Matrix6d::Zero();
}

/// The same behaviour on every backend.
class SqlStore : public OnEveryBackend
{
protected:
  void SetUp() override
  {
    OnEveryBackend::SetUp();
    if (!IsSkipped())
      store_ = openSqlStore(connection_);
  }
  void reopen()
  {
    store_.reset();
    store_ = openSqlStore(connection_);
  }
  StatusCode codeOf(const std::function<void()>& call) { return statusOf(call).code; }

  std::unique_ptr<SessionStore> store_;
};
INSTANTIATE_ON_EVERY_BACKEND(SqlStore);

TEST_P(SqlStore, KeepsSessions)
{
  EXPECT_TRUE(store_->listSessions().empty());
  Session session = makeSession("late");
  session.started_s = 20;
  store_->createSession(session);
  session = makeSession("early");
  session.started_s = 10.000000125;
  session.reference_is_object = true;
  session.support_plane_session = geometry::Plane{ Eigen::Vector3d(1, 2, 3).normalized(), 1.0 / 3 };
  session.T_model_session = makeKeyframe(1).T_session_camera;
  store_->createSession(session);
  reopen();

  const std::vector<Session> sessions = store_->listSessions();
  ASSERT_EQ(sessions.size(), 2u);
  EXPECT_EQ(sessions[0].id, "early");
  EXPECT_EQ(sessions[1].id, "late");
  const Session read = store_->session("early");
  EXPECT_EQ(read.object_id, "cup");
  EXPECT_EQ(read.camera_frame_id, session.camera_frame_id);
  EXPECT_EQ(read.started_s, session.started_s);
  EXPECT_EQ(read.keyframe_count, 0);
  EXPECT_TRUE(read.reference_is_object);
  EXPECT_FALSE(read.closed);
  EXPECT_EQ(read.support_plane_session->normal, session.support_plane_session->normal);
  EXPECT_EQ(read.support_plane_session->offset_m, session.support_plane_session->offset_m);
  EXPECT_EQ(read.T_model_session->matrix(), session.T_model_session->matrix());
  EXPECT_FALSE(sessions[1].support_plane_session || sessions[1].T_model_session || sessions[1].reference_is_object);
}

TEST_P(SqlStore, KeepsOneAlignmentForAPairInEitherOrder)
{
  for (const char* id : { "a", "b", "c" })
    store_->createSession(makeSession(id));
  EXPECT_TRUE(store_->alignments().empty());
  store_->updateAlignments({ { "b", "c", "first: 'x'\n" }, { "a", "b", "\xc3\xa4 %" } });
  reopen();
  std::vector<AlignmentRecord> records = store_->alignments();
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].session_a + records[0].session_b + records[0].findings, "ab\xc3\xa4 %");
  EXPECT_EQ(records[1].findings, "first: 'x'\n");

  store_->updateAlignments({ { "c", "b", "second" } });
  records = store_->alignments();
  ASSERT_EQ(records.size(), 2u) << "the other order is the same pair";
  EXPECT_EQ(records[1].session_a + records[1].findings, "csecond");

  store_->updateAlignments({ { "b", "c", "" } });
  EXPECT_EQ(store_->alignments().size(), 1u) << "forgotten";
  store_->deleteSession("b");
  EXPECT_TRUE(store_->alignments().empty()) << "goes with its session";
}

TEST_P(SqlStore, TakesAllAlignmentsOrNone)
{
  store_->createSession(makeSession("a"));
  store_->createSession(makeSession("b"));
  EXPECT_EQ(codeOf(
                [&] {
                  store_->updateAlignments({ { "a", "b", "x" }, { "a", "missing", "y" } });
                }),
            StatusCode::NOT_FOUND);
  EXPECT_TRUE(store_->alignments().empty());
  EXPECT_EQ(codeOf([&] { store_->updateAlignments({ { "a", "a", "x" } }); }), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(codeOf(
                [&] {
                  store_->updateAlignments({ { "a", "b'; DROP TABLE sessions", "x" } });
                }),
            StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(codeOf(
                [&] {
                  store_->updateAlignments({ { "a", "b", std::string("x\0y", 3) } });
                }),
            StatusCode::INVALID_ARGUMENT);
}

TEST_P(SqlStore, UpdatesSessions)
{
  store_->createSession(makeSession("a"));
  Session changed = makeSession("a");
  changed.object_id = "box";
  changed.camera_frame_id = "not updated";
  changed.closed = true;
  changed.T_model_session = Eigen::Isometry3d::Identity();
  changed.calibration = makeCalibration();
  changed.refinement_report = "it's \xc3\xa9\n100 % refined";
  store_->update(changed.id, SessionChange::toAllOf(changed));
  Session read = store_->session("a");
  EXPECT_TRUE(read.calibration == changed.calibration);
  EXPECT_EQ(read.refinement_report, changed.refinement_report);
  EXPECT_EQ(read.object_id, "box");
  EXPECT_EQ(read.camera_frame_id, makeSession("a").camera_frame_id);
  EXPECT_TRUE(read.closed);
  EXPECT_TRUE(read.T_model_session);
  changed.T_model_session.reset();
  changed.calibration = rgbd::SensorCalibration();
  store_->update(changed.id, SessionChange::toAllOf(changed));
  EXPECT_TRUE(store_->session("a").calibration == rgbd::SensorCalibration());
  EXPECT_FALSE(store_->session("a").T_model_session);
}

TEST_P(SqlStore, KeyframesHaveTheNoiseModelOfTheirSession)
{
  Session calibrated = makeSession("a");
  calibrated.calibration = makeCalibration();
  store_->createSession(calibrated);
  store_->createSession(makeSession("b"));
  store_->addKeyframe("a", makeKeyframe(0));
  store_->addKeyframe("b", makeKeyframe(0));
  EXPECT_TRUE(store_->keyframe("a", 0).frame.noise_model == makeCalibration().noise_model);
  EXPECT_TRUE(store_->keyframe("b", 0).frame.noise_model == rgbd::SensorNoiseModel());
}

TEST_P(SqlStore, KeyframesAreCorrectedByTheirSessionsCalibration)
{
  store_->createSession(makeSession("a"));
  store_->addKeyframe("a", makeKeyframe(0));
  const rgbd::Keyframe before = store_->keyframe("a", 0);
  Session calibrated = store_->session("a");
  calibrated.calibration.correction.focal_ratio = { 1.01, 0.99 };
  calibrated.calibration.correction.depth_offset_m = 0.005;
  store_->update(calibrated.id, SessionChange::toAllOf(calibrated));
  EXPECT_TRUE(store_->session("a").calibration == calibrated.calibration);
  const rgbd::Keyframe after = store_->keyframe("a", 0);
  EXPECT_DOUBLE_EQ(after.frame.camera.fx, 1.01 * before.frame.camera.fx);
  EXPECT_DOUBLE_EQ(after.frame.camera.fy, 0.99 * before.frame.camera.fy);
  EXPECT_NEAR(cv::norm(after.frame.depth_m, before.frame.depth_m + 0.005, cv::NORM_INF,
                       before.frame.depth_m == before.frame.depth_m),
              0, 1e-6);
  ASSERT_EQ(after.observations.size(), before.observations.size());
  for (std::size_t i = 0; i < before.observations.size(); ++i)
  {
    const float error_m = after.observations[i].depth_m - before.observations[i].depth_m - 0.005F;
    EXPECT_TRUE(std::isnan(before.observations[i].depth_m) || std::abs(error_m) < 1e-6) << error_m;
  }
}

TEST_P(SqlStore, RefusesAnImpossibleCalibration)
{
  Session session = makeSession("a");
  session.calibration.noise_model.axial_constant_m = -1;
  const base::Status status = statusOf([&] { store_->createSession(session); });
  EXPECT_EQ(status.code, StatusCode::INVALID_ARGUMENT);
  EXPECT_NE(status.message.find("axial_constant_m"), std::string::npos) << status.message;
  session = makeSession("a");
  session.calibration.color_offset_px.x() = std::nan("");
  EXPECT_EQ(statusOf([&] { store_->createSession(session); }).code, StatusCode::INVALID_ARGUMENT);
}

TEST_P(SqlStore, KeepsKeyframesAcrossReopening)
{
  store_->createSession(makeSession("a"));
  for (const int id : { 2, 0, 5 })
    store_->addKeyframe("a", makeKeyframe(id));
  reopen();
  EXPECT_EQ(store_->keyframeIds("a"), (std::vector<int>{ 0, 2, 5 }));
  EXPECT_EQ(store_->session("a").keyframe_count, 3);
  EXPECT_EQ(store_->session("a").started_s, makeKeyframe(2).frame.stamp_s);
  const std::vector<rgbd::Keyframe> keyframes = loadKeyframes(*store_, "a");
  ASSERT_EQ(keyframes.size(), 3u);
  for (const rgbd::Keyframe& keyframe : keyframes)
  {
    const rgbd::Keyframe expected = makeKeyframe(keyframe.id);
    expectSame(keyframe, expected);
    EXPECT_LE(depthDifference_m(keyframe.frame.depth_m, expected.frame.depth_m), 0.5e-4 + 1e-6);
  }
}

TEST_P(SqlStore, UpdatesPosesAllOrNone)
{
  store_->createSession(makeSession("a"));
  store_->addKeyframe("a", makeKeyframe(0));
  store_->addKeyframe("a", makeKeyframe(1));
  const rgbd::Keyframe moved = makeKeyframe(7);
  store_->update("a", SessionChange::ofPoses({ { 1, moved.T_session_camera, moved.covariance } }));
  EXPECT_EQ(store_->keyframe("a", 1).T_session_camera.matrix(), moved.T_session_camera.matrix());
  EXPECT_EQ(store_->keyframe("a", 1).covariance, moved.covariance);

  const Eigen::Isometry3d other = makeKeyframe(9).T_session_camera;
  EXPECT_EQ(
      codeOf(
          [&] {
            store_->update("a", SessionChange::ofPoses({ { 0, other, NO_COVARIANCE }, { 42, other, NO_COVARIANCE } }));
          }),
      StatusCode::NOT_FOUND);
  EXPECT_EQ(store_->keyframe("a", 0).T_session_camera.matrix(), makeKeyframe(0).T_session_camera.matrix());
  EXPECT_EQ(
      codeOf(
          [&] {
            store_->update("a", SessionChange::ofPoses({ { 0, other, NO_COVARIANCE }, { 0, other, NO_COVARIANCE } }));
          }),
      StatusCode::INVALID_ARGUMENT);
  Eigen::Isometry3d broken = other;
  broken(0, 3) = std::nan("");
  EXPECT_EQ(codeOf(
                [&] {
                  store_->update("a", SessionChange::ofPoses({ { 0, broken, NO_COVARIANCE } }));
                }),
            StatusCode::INVALID_ARGUMENT);
}

TEST_P(SqlStore, UpdatesMasksAllOrNone)
{
  store_->createSession(makeSession("a"));
  store_->addKeyframe("a", makeKeyframe(0));
  store_->addKeyframe("a", makeKeyframe(1));
  cv::Mat mask(48, 64, CV_8UC1, cv::Scalar(0));
  mask.at<unsigned char>(3, 4) = 255;
  const auto countIn = [&](int id) { return cv::countNonZero(store_->keyframe("a", id).frame.object_mask); };
  store_->update("a", SessionChange::ofMasks({ { 0, mask }, { 1, cv::Mat() } }));
  EXPECT_EQ(countIn(0), 1);
  EXPECT_TRUE(store_->keyframe("a", 1).frame.object_mask.empty());
  store_->update("a", SessionChange::ofMasks({ { 1, mask } }));
  EXPECT_EQ(countIn(1), 1);

  mask.setTo(255);
  EXPECT_EQ(codeOf(
                [&] {
                  store_->update("a", SessionChange::ofMasks({ { 0, mask }, { 1, mask.rowRange(0, 5) } }));
                }),
            StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(codeOf(
                [&] {
                  store_->update("a", SessionChange::ofMasks({ { 0, mask }, { 8, mask } }));
                }),
            StatusCode::NOT_FOUND);
  EXPECT_EQ(countIn(0), 1);
  // What moved with the object was measured, and stays.
  EXPECT_EQ(cv::norm(store_->keyframe("a", 0).frame.moving_mask, makeKeyframe(0).frame.moving_mask, cv::NORM_INF), 0);
}

TEST_P(SqlStore, DeletesASessionWithAllThatBelongsToIt)
{
  store_->createSession(makeSession("a"));
  store_->createSession(makeSession("b"));
  store_->addKeyframe("a", makeKeyframe(0));
  store_->addKeyframe("b", makeKeyframe(0));
  store_->deleteSession("a");
  EXPECT_EQ(codeOf([&] { store_->keyframe("a", 0); }), StatusCode::NOT_FOUND);
  store_->createSession(makeSession("a"));
  EXPECT_TRUE(store_->keyframeIds("a").empty());
  store_->addKeyframe("a", makeKeyframe(0));
  expectSame(store_->keyframe("b", 0), makeKeyframe(0));
}

TEST_P(SqlStore, SaysWhatIsMissingOrTaken)
{
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const std::function<void()>& call :
       std::vector<std::function<void()>>{
           [&] { store_->session("none"); }, [&] { store_->update("none", {}); },
           [&] { store_->deleteSession("none"); }, [&] { store_->addKeyframe("none", makeKeyframe(0)); },
           [&] { store_->keyframeIds("none"); }, [&] { store_->keyframe("none", 0); },
           [&] {
             store_->update("none", SessionChange::ofPoses({ { 0, pose, NO_COVARIANCE } }));
           },
           [&] { store_->update("none", SessionChange::ofMasks({})); },
           [&] { store_->exportSession("none", folder_.path("out.db")); } })
  {
    const base::Status status = statusOf(call);
    EXPECT_EQ(status.code, StatusCode::NOT_FOUND);
    EXPECT_NE(status.message.find("'none'"), std::string::npos) << status.message;
  }
  store_->createSession(makeSession("a"));
  store_->addKeyframe("a", makeKeyframe(0));
  EXPECT_EQ(codeOf([&] { store_->createSession(makeSession("a")); }), StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(codeOf([&] { store_->addKeyframe("a", makeKeyframe(0)); }), StatusCode::FAILED_PRECONDITION);
  const base::Status status = statusOf([&] { store_->keyframe("a", 3); });
  EXPECT_EQ(status.code, StatusCode::NOT_FOUND);
  EXPECT_NE(status.message.find("keyframe 3"), std::string::npos) << status.message;
  EXPECT_EQ(store_->keyframeIds("a").size(), 1u);
}

TEST_P(SqlStore, RefusesHostileIds)
{
  store_->createSession(makeSession("a"));
  for (const std::string& id : { std::string("'; DROP TABLE sessions; --"), std::string("../x"), std::string(),
                                 std::string(65, 'x'), std::string("a\0b", 3), std::string("a' OR '1'='1") })
  {
    EXPECT_EQ(codeOf([&] { store_->createSession(makeSession(id)); }), StatusCode::INVALID_ARGUMENT) << id;
    EXPECT_EQ(codeOf([&] { store_->session(id); }), StatusCode::INVALID_ARGUMENT) << id;
    EXPECT_EQ(codeOf([&] { store_->deleteSession(id); }), StatusCode::INVALID_ARGUMENT) << id;
    EXPECT_EQ(codeOf([&] { store_->addKeyframe(id, makeKeyframe(0)); }), StatusCode::INVALID_ARGUMENT) << id;
    EXPECT_EQ(codeOf([&] { store_->exportSession(id, folder_.path("x")); }), StatusCode::INVALID_ARGUMENT) << id;
  }
  Session session = makeSession("b");
  session.object_id = "../x";
  EXPECT_EQ(codeOf([&] { store_->createSession(session); }), StatusCode::INVALID_ARGUMENT);
  session = makeSession("b");
  session.camera_frame_id = "'); DROP TABLE sessions; --";  // any text: it goes nowhere but into its column
  store_->createSession(session);
  EXPECT_EQ(store_->session("b").camera_frame_id, session.camera_frame_id);
  EXPECT_EQ(store_->listSessions().size(), 2u);
}

TEST_P(SqlStore, RefusesKeyframesThatDoNotFit)
{
  store_->createSession(makeSession("a"));
  rgbd::Keyframe keyframe = makeKeyframe(0);
  keyframe.frame.depth_m = keyframe.frame.depth_m.rowRange(0, 10);
  EXPECT_EQ(codeOf([&] { store_->addKeyframe("a", keyframe); }), StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(store_->keyframeIds("a").empty());
  store_->addKeyframe("a", makeKeyframe(0));
}

TEST_P(SqlStore, ServesSeveralThreads)
{
  constexpr int THREADS = 4, PER_THREAD = 8;
  store_->createSession(makeSession("a"));
  std::atomic<int> failures{ 0 };
  std::vector<std::thread> threads;
  for (int t = 0; t < THREADS; ++t)
    threads.emplace_back(
        [&, t]
        {
          for (int i = 0; i < PER_THREAD; ++i)
          {
            const int id = t * PER_THREAD + i;
            const StatusCode code = codeOf(
                [&]
                {
                  store_->addKeyframe("a", makeKeyframe(id));
                  store_->update("a", SessionChange::ofPoses({ { id, Eigen::Isometry3d::Identity(), NO_COVARIANCE } }));
                  if (store_->keyframe("a", id).id != id || store_->listSessions().size() != 1)
                    ++failures;
                });
            failures += code != StatusCode::OK;
          }
        });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(store_->keyframeIds("a").size(), static_cast<std::size_t>(THREADS * PER_THREAD));
}

TEST_P(SqlStore, SharesItsDataWithAnotherConnection)
{
  const std::unique_ptr<SessionStore> other = openSqlStore(connection_);
  store_->createSession(makeSession("a"));
  other->addKeyframe("a", makeKeyframe(0));
  expectSame(store_->keyframe("a", 0), makeKeyframe(0));
}

}  // namespace object_modelling::keyframes
