#include <filesystem>

#include "object_modelling/pipeline/align_sessions.h"
#include "session_fixture.h"

namespace object_modelling::pipeline
{
TEST_F(SessionJobs, SegmentWritesMasksAndSupportPlane)
{
  const SegmentReport report = segmentStoredSession(*store_, WALK, std::nullopt, {}, control_);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_EQ(report.session_id, WALK);
  EXPECT_EQ(report.masked_count, report.keyframe_count);
  EXPECT_TRUE(report.support_plane_found);

  for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store_, WALK))
  {
    const auto index = std::lround((keyframe.frame.stamp_s - recording_.frames[0].stamp_s) * 30);
    const rgbd::Frame& frame = recording_.frames.at(index);
    const cv::Mat truth = frame.object_mask & (frame.depth_m > 0);  // no depth, no mask
    ASSERT_FALSE(keyframe.frame.object_mask.empty());
    EXPECT_GT(cv::countNonZero(keyframe.frame.object_mask & truth), 0.9 * cv::countNonZero(truth)) << keyframe.id;
    EXPECT_LT(cv::countNonZero(keyframe.frame.object_mask & ~truth), 0.05 * cv::countNonZero(truth)) << keyframe.id;
  }
  const keyframes::Session session = store_->session(WALK);
  ASSERT_TRUE(session.support_plane_session);
  // The box's frame has its origin 0.1 m above the table.
  const Eigen::Isometry3d T_object_session = recording_.T_object_cameras[0];
  const geometry::Plane plane = geometry::transformed(T_object_session, *session.support_plane_session);
  EXPECT_GT(plane.normal.z(), std::cos(0.01));
  EXPECT_NEAR(plane.signedDistance_m(Eigen::Vector3d::Zero()), 0.1, 0.003);
}

TEST_F(SessionJobs, SegmentTakesTheObjectThatIsNamed)
{
  const Eigen::Vector3d center_session = recording_.T_object_cameras[0].inverse() * Eigen::Vector3d::Zero();
  EXPECT_TRUE(segmentStoredSession(*store_, WALK, center_session, {}, control_).status.ok());
  const std::string before = fingerprint(*store_, WALK);
  const Eigen::Vector3d nowhere_session(0, -5, 0);
  const SegmentReport report = segmentStoredSession(*store_, WALK, nowhere_session, {}, control_);
  EXPECT_EQ(report.status.code, StatusCode::NO_RESULT);
  EXPECT_NE(report.status.message, "");
  EXPECT_EQ(fingerprint(*store_, WALK), before);
}

TEST_F(SessionJobs, LeaveToOthersWhatTheyDoNotMake)
{
  const auto other = keyframes::openSqlStore(folder_.path("store.db"));
  keyframes::SessionChange meanwhile;
  meanwhile.object_id = "named_meanwhile";
  base::JobControl interrupted([&](const base::Progress&) { other->update(WALK, meanwhile); });
  ASSERT_TRUE(segmentStoredSession(*store_, WALK, std::nullopt, {}, interrupted).status.ok());
  EXPECT_EQ(store_->session(WALK).object_id, "named_meanwhile");
  meanwhile.object_id = "named_again";
  ASSERT_TRUE(refineStoredSession(*store_, WALK, {}, interrupted).status.ok());
  EXPECT_EQ(store_->session(WALK).object_id, "named_again");
  EXPECT_TRUE(store_->session(WALK).segmented.done());
}

TEST_F(SessionJobs, AlignPlacesOneWithoutLookingAtIt)
{
  const alignment::AlignmentResult one = alignStoredSessions(*store_, { WALK }, {}, control_);
  EXPECT_TRUE(one.status.ok());
  ASSERT_EQ(one.placements.size(), 1u);
  EXPECT_EQ(one.placements[0].session_id, WALK);
  EXPECT_EQ(one.placements[0].T_reference_session.matrix(), Eigen::Isometry3d::Identity().matrix());
  EXPECT_EQ(alignStoredSessions(*store_, {}, {}, control_).status.code, StatusCode::INVALID_ARGUMENT);
}

/// The rendered sessions differ in their walks alone.
AlignOptions samePose()
{
  AlignOptions options;
  options.pair.same_pose_probability = 0.5;
  return options;
}

TEST_F(SessionJobs, AlignPlacesSessionsOfTheSameObjectAndKeepsWhatItFound)
{
  // Both stand in the same world, which is their session frame.
  storeRenderedSession(*store_, "one", 12);
  storeRenderedSession(*store_, "two", 9);
  const std::string before = fingerprint(*store_, "one") + fingerprint(*store_, "two");
  const alignment::AlignmentResult two = alignStoredSessions(*store_, { "one", "two" }, samePose(), control_);
  ASSERT_TRUE(two.status.ok()) << two.status.message;
  ASSERT_EQ(two.placements.size(), 2u);
  EXPECT_TRUE(two.placements[1].T_reference_session.isApprox(Eigen::Isometry3d::Identity(), 0.005))
      << two.placements[1].T_reference_session.matrix();
  ASSERT_EQ(two.edges.size(), 1u);
  EXPECT_TRUE(two.edges[0].accepted);
  EXPECT_EQ(fingerprint(*store_, "one") + fingerprint(*store_, "two"), before) << "the sessions stay as they are";

  const alignment::AlignmentEdge known = knownAlignment(*store_, "two", "one");
  EXPECT_TRUE(known.accepted);
  EXPECT_EQ(known.best()->T_a_b.matrix(), two.edges[0].best()->T_a_b.matrix());
  store_->updateAlignments({ { "one", "two", "no: yaml: [" } });
  EXPECT_TRUE(alignStoredSessions(*store_, { "one", "two" }, samePose(), control_).status.ok())
      << "what cannot be read is found anew";
}

TEST_F(SessionJobs, APersonDecidesOnAlignments)
{
  storeRenderedSession(*store_, "one", 12);
  storeRenderedSession(*store_, "two", 9);
  EXPECT_EQ(statusOf([&] { acceptAlignment(*store_, "one", "two", 0); }).code, StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(statusOf([&] { acceptAlignment(*store_, "one", "missing", 0); }).code, StatusCode::NOT_FOUND);
  ASSERT_TRUE(alignStoredSessions(*store_, { "one", "two" }, samePose(), control_).status.ok());

  refuseAlignment(*store_, "two", "one");
  const alignment::AlignmentResult refused = alignStoredSessions(*store_, { "one", "two" }, samePose(), control_);
  EXPECT_EQ(refused.status.code, StatusCode::NO_RESULT);
  EXPECT_NE(refused.status.message.find("refused by a person"), std::string::npos) << refused.status.message;
  AlignOptions anew = samePose();
  anew.use_known = false;
  EXPECT_EQ(alignStoredSessions(*store_, { "one", "two" }, anew, control_).status.code, StatusCode::NO_RESULT);

  EXPECT_EQ(statusOf([&] { acceptAlignment(*store_, "one", "two", 90); }).code, StatusCode::INVALID_ARGUMENT);
  acceptAlignment(*store_, "one", "two", 0);
  EXPECT_TRUE(alignStoredSessions(*store_, { "one", "two" }, samePose(), control_).status.ok());
  forgetAlignment(*store_, "one", "two");
  EXPECT_TRUE(knownAlignment(*store_, "one", "two").candidates.empty());
  EXPECT_TRUE(alignStoredSessions(*store_, { "one", "two" }, samePose(), control_).status.ok());
  EXPECT_EQ(knownAlignment(*store_, "one", "two").decision, alignment::Decision::AUTOMATIC);
}

TEST_F(SessionJobs, AlignRefusesASessionWithoutMasks)
{
  storeRenderedSession(*store_, "one", 9);
  const base::Status status = statusOf([this] { alignStoredSessions(*store_, { "one", WALK }, {}, control_); });
  EXPECT_EQ(status.code, StatusCode::FAILED_PRECONDITION) << status.message;
  EXPECT_NE(status.message.find(WALK), std::string::npos) << status.message;
}

TEST_F(SessionJobs, SayWhatIsMissing)
{
  const std::vector<std::pair<std::string, std::function<base::Status(const std::string&)>>> jobs = {
    { "segment",
      [this](const std::string& id) { return segmentStoredSession(*store_, id, std::nullopt, {}, control_).status; } },
    { "refine", [this](const std::string& id) { return refineStoredSession(*store_, id, {}, control_).status; } },
  };
  store_->createSession(named("empty"));
  for (const auto& [name, job] : jobs)
  {
    const base::Status empty = job("empty");
    EXPECT_EQ(empty.code, StatusCode::FAILED_PRECONDITION) << name;
    EXPECT_NE(empty.message.find("'empty' has no keyframes"), std::string::npos) << name << ": " << empty.message;
    const base::Status unknown = statusOf([&, &run = job] { run("unknown"); });
    EXPECT_EQ(unknown.code, StatusCode::NOT_FOUND) << name;
    EXPECT_NE(unknown.message.find("unknown"), std::string::npos) << name << ": " << unknown.message;
  }
  EXPECT_EQ(statusOf(
                [this] {
                  alignStoredSessions(*store_, { WALK, "unknown" }, {}, control_);
                })
                .code,
            StatusCode::NOT_FOUND);
}

TEST_F(SessionJobs, LeaveTheSessionAsItWasWhenCancelled)
{
  const std::string before = fingerprint(*store_, WALK);
  for (const std::string stage : { "load", "segment", "refine" })
  {
    base::JobControl* hand = nullptr;
    bool reached = false;
    base::JobControl control(
        [&](const base::Progress& progress)
        {
          if (progress.stage == "load" && stage != "load")
            return;
          reached = true;
          hand->cancel();
        });
    hand = &control;
    if (stage == "segment")
      EXPECT_THROW(segmentStoredSession(*store_, WALK, std::nullopt, {}, control), base::Cancelled) << stage;
    else
      EXPECT_THROW(refineStoredSession(*store_, WALK, {}, control), base::Cancelled) << stage;
    EXPECT_TRUE(reached) << stage;
    EXPECT_EQ(fingerprint(*store_, WALK), before) << stage;
  }
}

}  // namespace object_modelling::pipeline
