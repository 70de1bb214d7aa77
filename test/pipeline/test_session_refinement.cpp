#include "session_fixture.h"

namespace object_modelling::pipeline
{
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

  const bundle_adjustment::BundleAdjustmentResult result = refineStoredSession(*store_, WALK, {}, control_);
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
  ASSERT_TRUE(refineStoredSession(*store_, WALK, {}, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).refined.by, "bundle_adjustment");
  ASSERT_TRUE(segmentStoredSession(*store_, WALK, std::nullopt, {}, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).segmented.by, keyframes::stage_mark::AUTOMATIC);
  const Eigen::Vector3d center_session = recording_.T_object_cameras[0].inverse() * Eigen::Vector3d::Zero();
  ASSERT_TRUE(segmentStoredSession(*store_, WALK, center_session, {}, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).segmented.by, keyframes::stage_mark::BY_HAND);
  EXPECT_NE(store_->session(WALK).segmented.options.find("seed_point_session_m: ["), std::string::npos);
}

TEST_F(SessionJobs, AReportGoesWithThePosesThatItIsOf)
{
  ASSERT_TRUE(refineStoredSession(*store_, WALK, {}, control_).status.ok());
  EXPECT_NE(store_->session(WALK).refinement_report, "");
  RefinementOptions surfaces_alone;
  surfaces_alone.method = RefinementMethod::MULTI_VIEW_ICP;
  ASSERT_TRUE(refineSessionBy(*store_, WALK, surfaces_alone, control_).status.ok());
  EXPECT_EQ(store_->session(WALK).refinement_report, "");
}

TEST_F(SessionJobs, RefineUsesTheObjectAloneWhereTheRestMoves)
{
  ASSERT_TRUE(segmentStoredSession(*store_, WALK, std::nullopt, {}, control_).status.ok());
  const int whole_scene = refinedObservationCount();
  keyframes::Session session = store_->session(WALK);
  session.reference_is_object = true;
  store_->update(session.id, keyframes::SessionChange::toAllOf(session));
  const int object_alone = refinedObservationCount();
  EXPECT_GT(object_alone, 0);
  EXPECT_LT(object_alone, whole_scene / 2);
}

TEST_F(SessionJobs, RefineUsesWhatMovedWithTheObject)
{
  ASSERT_TRUE(segmentStoredSession(*store_, WALK, std::nullopt, {}, control_).status.ok());
  const auto observationsBy = [&](const std::string& id, bool all_moves)
  {
    keyframes::Session session = named(id);
    session.reference_is_object = true;
    store_->createSession(session);
    for (rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store_, WALK))
    {
      if (all_moves)
        keyframe.frame.moving_mask = cv::Mat(keyframe.frame.depth_m.size(), CV_8UC1, cv::Scalar(255));
      store_->addKeyframe(id, keyframe);
    }
    return refinedObservationCount(id);
  };
  const int object_alone = observationsBy("object", false);
  EXPECT_GT(object_alone, 0);
  EXPECT_GT(observationsBy("all", true), 2 * object_alone);
}

TEST_F(SessionJobs, RefineLeavesPosesThatNothingLinks)
{
  storeRenderedSession(*store_, "unlinked", 3);
  const std::string before = fingerprint(*store_, "unlinked");
  bundle_adjustment::BundleAdjustmentOptions options;
  options.link_keyframes = false;
  EXPECT_EQ(refineStoredSession(*store_, "unlinked", options, control_).status.code, StatusCode::NO_RESULT);
  EXPECT_EQ(fingerprint(*store_, "unlinked"), before);
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
    EXPECT_EQ(refined.keyframe_ids, store_->keyframeIds(WALK));
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

}  // namespace object_modelling::pipeline
