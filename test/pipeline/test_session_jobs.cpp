#include <gtest/gtest.h>

#include <filesystem>

#include "object_modelling/pipeline/align_sessions.h"
#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/pipeline/session_refinement.h"
#include "recordings.h"
#include "support/temp_dir.h"
#include "support/transform_matchers.h"

namespace object_modelling::pipeline
{
using base::StatusCode;

namespace
{
constexpr int FRAMES = 24;
constexpr double TURN_RAD = 1.2;
constexpr char WALK[] = "walk";
}  // namespace

/// Every test has its own copy of one recorded session.
class SessionJobs : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    recorded_ = std::make_unique<test_support::TempDir>();
    const auto store = keyframes::openSqlStore(recorded_->path("store.db"));
    MemorySource source(walkRoundBox(FRAMES, TURN_RAD));
    base::JobControl control;
    recordSession(source, named(WALK), store.get(), {}, control);
    store->exportSession(WALK, recorded_->path("walk.db"));
  }
  static void TearDownTestSuite() { recorded_.reset(); }

  void SetUp() override { store_->importSession(recorded_->path("walk.db")); }

  Eigen::Isometry3d trueT_session_camera(double stamp_s) const
  {
    const auto index = std::lround((stamp_s - recording_.frames[0].stamp_s) * 30);
    return recording_.T_object_cameras[0].inverse() * recording_.T_object_cameras.at(index);
  }
  double worstPosition_m(const std::string& session_id = WALK)
  {
    double worst_m = 0;
    for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store_, session_id))
      worst_m = std::max(worst_m, (keyframe.T_session_camera.translation() -
                                   trueT_session_camera(keyframe.frame.stamp_s).translation())
                                      .norm());
    return worst_m;
  }
  int refinedObservationCount()
  {
    const refinement::BundleAdjustmentResult result = refineSession(*store_, WALK, {}, control_);
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    int count = 0;
    for (const refinement::KeyframeResidual& residual : result.residuals)
      count += residual.observation_count;
    return count;
  }

  static std::unique_ptr<test_support::TempDir> recorded_;
  const Recording& recording_ = walkRoundBox(FRAMES, TURN_RAD);
  test_support::TempDir folder_;
  std::unique_ptr<keyframes::SessionStore> store_ = keyframes::openSqlStore(folder_.path("store.db"));
  base::JobControl control_;
};
std::unique_ptr<test_support::TempDir> SessionJobs::recorded_;

TEST_F(SessionJobs, SegmentWritesMasksAndSupportPlane)
{
  const SegmentReport report = segmentSession(*store_, WALK, std::nullopt, {}, control_);
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
  const Eigen::Vector3d centre_session = recording_.T_object_cameras[0].inverse() * Eigen::Vector3d::Zero();
  EXPECT_TRUE(segmentSession(*store_, WALK, centre_session, {}, control_).status.ok());
  const std::string before = fingerprint(*store_, WALK);
  const Eigen::Vector3d nowhere_session(0, -5, 0);
  const SegmentReport report = segmentSession(*store_, WALK, nowhere_session, {}, control_);
  EXPECT_EQ(report.status.code, StatusCode::NO_RESULT);
  EXPECT_NE(report.status.message, "");
  EXPECT_EQ(fingerprint(*store_, WALK), before);
}

TEST_F(SessionJobs, RefineWritesThePosesBack)
{
  std::vector<keyframes::PoseUpdate> moved;
  for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store_, WALK))
  {
    Eigen::Isometry3d T = keyframe.T_session_camera;
    if (keyframe.id > 0)
      T.translation() += Eigen::Vector3d(0.006, keyframe.id % 2 == 0 ? 0.006 : -0.006, 0);
    moved.push_back({ keyframe.id, T, keyframe.covariance });
  }
  store_->update(WALK, keyframes::SessionChange::ofPoses(moved));
  EXPECT_GT(worstPosition_m(), 0.006);

  const refinement::BundleAdjustmentResult result = refineSession(*store_, WALK, {}, control_);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_LT(result.final_cost, result.initial_cost);
  EXPECT_LT(worstPosition_m(), 0.004);
  const std::vector<rgbd::Keyframe> stored = keyframes::loadKeyframes(*store_, WALK);
  for (std::size_t i = 0; i < stored.size(); ++i)
  {
    EXPECT_TRANSFORM_NEAR(stored[i].T_session_camera, result.T_session_camera[i], 1e-9, 1e-7);
    EXPECT_LT((stored[i].covariance - result.covariance[i]).norm(), 1e-9);
  }
}

TEST_F(SessionJobs, EachStageLeavesItsMark)
{
  EXPECT_FALSE(store_->session(WALK).refined.done() || store_->session(WALK).segmented.done());
  RefinementOptions surfaces_alone;
  surfaces_alone.method = RefinementMethod::MULTI_VIEW_ICP;
  ASSERT_TRUE(refineSessionBy(*store_, WALK, surfaces_alone, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).refined.by, "multi_view_icp");
  EXPECT_NE(store_->session(WALK).refined.options.find("start_error_m: 0.03"), std::string::npos)
      << store_->session(WALK).refined.options;
  ASSERT_TRUE(refineSession(*store_, WALK, {}, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).refined.by, "bundle_adjustment");
  ASSERT_TRUE(segmentSession(*store_, WALK, std::nullopt, {}, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).segmented.by, keyframes::stage_mark::AUTOMATIC);
  const Eigen::Vector3d centre_session = recording_.T_object_cameras[0].inverse() * Eigen::Vector3d::Zero();
  ASSERT_TRUE(segmentSession(*store_, WALK, centre_session, {}, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).segmented.by, keyframes::stage_mark::BY_HAND);
  EXPECT_NE(store_->session(WALK).segmented.options.find("seed_point_session_m: ["), std::string::npos);
}

TEST_F(SessionJobs, AReportGoesWithThePosesThatItIsOf)
{
  ASSERT_TRUE(refineSession(*store_, WALK, {}, control_).status.ok());
  EXPECT_NE(store_->session(WALK).refinement_report, "");
  RefinementOptions surfaces_alone;
  surfaces_alone.method = RefinementMethod::MULTI_VIEW_ICP;
  ASSERT_TRUE(refineSessionBy(*store_, WALK, surfaces_alone, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).refinement_report, "");
}

TEST_F(SessionJobs, LeaveToOthersWhatTheyDoNotMake)
{
  const auto other = keyframes::openSqlStore(folder_.path("store.db"));
  keyframes::SessionChange meanwhile;
  meanwhile.object_id = "named_meanwhile";
  base::JobControl interrupted([&](const base::Progress&) { other->update(WALK, meanwhile); });
  ASSERT_TRUE(segmentSession(*store_, WALK, std::nullopt, {}, interrupted).status.ok());
  EXPECT_EQ(store_->session(WALK).object_id, "named_meanwhile");
  meanwhile.object_id = "named_again";
  ASSERT_TRUE(refineSession(*store_, WALK, {}, interrupted).status.ok());
  EXPECT_EQ(store_->session(WALK).object_id, "named_again");
  EXPECT_TRUE(store_->session(WALK).segmented.done());
}

TEST_F(SessionJobs, RefineUsesTheObjectAloneWhereTheRestMoves)
{
  ASSERT_TRUE(segmentSession(*store_, WALK, std::nullopt, {}, control_).status.ok());
  const int whole_scene = refinedObservationCount();
  keyframes::Session session = store_->session(WALK);
  session.reference_is_object = true;
  store_->update(session.id, keyframes::SessionChange::toAllOf(session));
  const int object_alone = refinedObservationCount();
  EXPECT_GT(object_alone, 0);
  EXPECT_LT(object_alone, whole_scene / 2);
}

TEST_F(SessionJobs, RefineLeavesPosesThatNothingLinks)
{
  storeRenderedSession(*store_, "unlinked", 3);
  const std::string before = fingerprint(*store_, "unlinked");
  refinement::BundleAdjustmentOptions options;
  options.link_keyframes = false;
  EXPECT_EQ(refineSession(*store_, "unlinked", options, control_).status.code, StatusCode::NO_RESULT);
  EXPECT_EQ(fingerprint(*store_, "unlinked"), before);
}

TEST_F(SessionJobs, AlignPlacesOneWithoutLookingAtIt)
{
  const alignment::AlignmentResult one = alignSessions(*store_, { WALK }, {}, control_);
  EXPECT_TRUE(one.status.ok());
  ASSERT_EQ(one.placements.size(), 1u);
  EXPECT_EQ(one.placements[0].session_id, WALK);
  EXPECT_EQ(one.placements[0].T_reference_session.matrix(), Eigen::Isometry3d::Identity().matrix());
  EXPECT_EQ(alignSessions(*store_, {}, {}, control_).status.code, StatusCode::INVALID_ARGUMENT);
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
  const alignment::AlignmentResult two = alignSessions(*store_, { "one", "two" }, samePose(), control_);
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
  EXPECT_TRUE(alignSessions(*store_, { "one", "two" }, samePose(), control_).status.ok())
      << "what cannot be read is found anew";
}

TEST_F(SessionJobs, APersonDecidesOnAlignments)
{
  storeRenderedSession(*store_, "one", 12);
  storeRenderedSession(*store_, "two", 9);
  EXPECT_EQ(statusOf([&] { acceptAlignment(*store_, "one", "two", 0); }).code, StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(statusOf([&] { acceptAlignment(*store_, "one", "missing", 0); }).code, StatusCode::NOT_FOUND);
  ASSERT_TRUE(alignSessions(*store_, { "one", "two" }, samePose(), control_).status.ok());

  refuseAlignment(*store_, "two", "one");
  const alignment::AlignmentResult refused = alignSessions(*store_, { "one", "two" }, samePose(), control_);
  EXPECT_EQ(refused.status.code, StatusCode::NO_RESULT);
  EXPECT_NE(refused.status.message.find("refused by a person"), std::string::npos) << refused.status.message;
  AlignOptions anew = samePose();
  anew.use_known = false;
  EXPECT_EQ(alignSessions(*store_, { "one", "two" }, anew, control_).status.code, StatusCode::NO_RESULT);

  EXPECT_EQ(statusOf([&] { acceptAlignment(*store_, "one", "two", 90); }).code, StatusCode::INVALID_ARGUMENT);
  acceptAlignment(*store_, "one", "two", 0);
  EXPECT_TRUE(alignSessions(*store_, { "one", "two" }, samePose(), control_).status.ok());
  forgetAlignment(*store_, "one", "two");
  EXPECT_TRUE(knownAlignment(*store_, "one", "two").candidates.empty());
  EXPECT_TRUE(alignSessions(*store_, { "one", "two" }, samePose(), control_).status.ok());
  EXPECT_EQ(knownAlignment(*store_, "one", "two").decision, alignment::Decision::AUTOMATIC);
}

TEST_F(SessionJobs, AlignRefusesASessionWithoutMasks)
{
  storeRenderedSession(*store_, "one", 9);
  const base::Status status = statusOf([this] { alignSessions(*store_, { "one", WALK }, {}, control_); });
  EXPECT_EQ(status.code, StatusCode::FAILED_PRECONDITION) << status.message;
  EXPECT_NE(status.message.find(WALK), std::string::npos) << status.message;
}

TEST_F(SessionJobs, RefineByTheMethodAskedFor)
{
  for (const RefinementMethod method :
       { RefinementMethod::BUNDLE_ADJUSTMENT, RefinementMethod::MULTI_VIEW_ICP, RefinementMethod::BOTH })
  {
    RefinementOptions options;
    options.method = method;
    const SessionRefinement refined = refineSessionBy(*store_, WALK, options, control_);
    ASSERT_TRUE(refined.status.ok()) << refined.status.message;
    EXPECT_EQ(refined.bundle_adjustment.has_value(), method != RefinementMethod::MULTI_VIEW_ICP);
    EXPECT_EQ(refined.multi_view_icp.has_value(), method != RefinementMethod::BUNDLE_ADJUSTMENT);
    EXPECT_LT(worstPosition_m(), 0.004);
    const std::vector<rgbd::Keyframe> stored = keyframes::loadKeyframes(*store_, WALK);
    ASSERT_EQ(refined.T_session_camera.size(), stored.size());
    for (std::size_t k = 0; k < stored.size(); ++k)
      EXPECT_TRANSFORM_NEAR(refined.T_session_camera[k], stored[k].T_session_camera, 1e-9, 1e-9);
  }
  EXPECT_EQ(statusOf([] { refinementMethodFrom("by hand"); }).code, StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(refinementMethodFrom("both"), RefinementMethod::BOTH);
}

TEST_F(SessionJobs, RefineWritesNothingWorseThanWhatWasThere)
{
  // Landmarks that agree with each other and not with the surfaces, as if each image were shifted more than the last.
  store_->createSession(named("misled"));
  for (rgbd::Keyframe keyframe : keyframes::loadKeyframes(*store_, WALK))
  {
    for (rgbd::Observation& observation : keyframe.observations)
      observation.pixel.x() += 5.0F * static_cast<float>(keyframe.id);
    store_->addKeyframe("misled", keyframe);
  }
  const double live_m = worstPosition_m("misled");
  RefinementOptions options;
  options.bundle_adjustment.link_keyframes = false;
  const SessionRefinement refined = refineSessionBy(*store_, "misled", options, control_);
  ASSERT_TRUE(refined.status.ok()) << refined.status.message;
  EXPECT_LT(worstPosition_m("misled"), 1.05 * live_m + 0.0005);
  ASSERT_EQ(refined.compared.size(), 4u);
  EXPECT_EQ(refined.compared.front().by, "live");
  EXPECT_GT(refined.compared[1].score.depth, 1.1 * refined.compared[0].score.depth) << "surfaces driven apart";
  EXPECT_TRUE(refined.chosen == "live" || refined.chosen == "multi_view_icp") << refined.chosen;
  EXPECT_NE(refined.status.message.find("kept the poses"), std::string::npos) << refined.status.message;
  const keyframes::Session session = store_->session("misled");
  EXPECT_EQ(session.refined.by, refined.chosen);
  EXPECT_NE(session.refined.options.find("compared:"), std::string::npos);
  EXPECT_EQ(session.refinement_report, "") << "of poses that were not taken";
}

TEST_F(SessionJobs, SurfacesRefineWhatNoLandmarksLink)
{
  store_->createSession(named("no_landmarks"));
  for (rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store_, WALK))
  {
    keyframe.observations.clear();
    store_->addKeyframe("no_landmarks", keyframe);
  }
  RefinementOptions options;
  options.method = RefinementMethod::MULTI_VIEW_ICP;
  const SessionRefinement refined = refineSessionBy(*store_, "no_landmarks", options, control_);
  EXPECT_TRUE(refined.status.ok()) << refined.status.message;
}

TEST_F(SessionJobs, CancelledIcpLeavesTheSessionAsItWas)
{
  const std::string before = fingerprint(*store_, WALK);
  base::JobControl* hand = nullptr;
  base::JobControl control(
      [&](const base::Progress& progress)
      {
        if (progress.stage == "multi-view icp")
          hand->cancel();
      });
  hand = &control;
  RefinementOptions options;
  options.method = RefinementMethod::BOTH;
  EXPECT_THROW(refineSessionBy(*store_, WALK, options, control), base::Cancelled);
  EXPECT_EQ(fingerprint(*store_, WALK), before);
}

TEST_F(SessionJobs, SayWhatIsMissing)
{
  const std::vector<std::pair<std::string, std::function<base::Status(const std::string&)>>> jobs = {
    { "segment",
      [this](const std::string& id) { return segmentSession(*store_, id, std::nullopt, {}, control_).status; } },
    { "refine", [this](const std::string& id) { return refineSession(*store_, id, {}, control_).status; } },
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
                  alignSessions(*store_, { WALK, "unknown" }, {}, control_);
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
      EXPECT_THROW(segmentSession(*store_, WALK, std::nullopt, {}, control), base::Cancelled) << stage;
    else
      EXPECT_THROW(refineSession(*store_, WALK, {}, control), base::Cancelled) << stage;
    EXPECT_TRUE(reached) << stage;
    EXPECT_EQ(fingerprint(*store_, WALK), before) << stage;
  }
}

}  // namespace object_modelling::pipeline
