#include "build_views.h"

#include "build_fixture.h"
#include "support/transform_matchers.h"

namespace object_modelling::pipeline
{
namespace
{
void setColorOffset(keyframes::SessionStore& store, const std::string& session_id, const Eigen::Vector2d& offset_px)
{
  keyframes::SessionChange change;
  change.calibration = store.session(session_id).calibration;
  change.calibration->color_offset_px = offset_px;
  store.update(session_id, change);
}

/// Makes the camera of these keyframes unsure by as much, in all directions.
void setSigma(keyframes::SessionStore& store, const std::string& session_id, const std::vector<int>& keyframe_ids,
              double translation_m, double rotation_rad)
{
  geometry::Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(translation_m), Eigen::Vector3d::Constant(rotation_rad);
  keyframes::SessionChange change;
  for (const int id : keyframe_ids)
  {
    const Eigen::Isometry3d T_session_camera = store.keyframe(session_id, id).T_session_camera;
    const geometry::Matrix6d adjoint = geometry::adjoint(T_session_camera);
    const geometry::Matrix6d covariance = adjoint * sigmas.cwiseAbs2().asDiagonal() * adjoint.transpose();
    change.poses.push_back({ id, T_session_camera, covariance });
  }
  store.update(session_id, change);
}
}  // namespace

TEST_F(BuildObject, KeyframesWhosePosesAreNotKnownAreLeftOutAndNamed)
{
  setSigma(*store_, "box", { 2, 5 }, 0.03, 0.001);
  setSigma(*store_, "box", { 7 }, 0.002, 0.003);
  Views views;
  ASSERT_TRUE(loadViews(*store_, { { "box", Eigen::Isometry3d::Identity() } }, control_, &views).ok());
  ASSERT_EQ(views.views.size(), 10u);
  ASSERT_EQ(views.origins.size(), 10u);
  EXPECT_EQ(views.origins[2].keyframe_id, 3);
  EXPECT_EQ(views.origins[5].keyframe_id, 7);
  ASSERT_EQ(views.warnings.size(), 1u);
  EXPECT_NE(views.warnings[0].find("session 'box': where the camera was is not known for 2 of 12 keyframes (2, 5;"),
            std::string::npos)
      << views.warnings[0];
  const BuildReport report = build({ "box" });
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_NE(report.status.message.find(views.warnings[0]), std::string::npos) << report.status.message;
}

TEST_F(BuildObject, OfASessionThatIsMostlyNotKnownAllIsTakenAndDoubted)
{
  setSigma(*store_, "box", { 1, 2, 3, 4, 5, 6, 7, 8 }, 0.001, 0.05);
  Views views;
  ASSERT_TRUE(loadViews(*store_, { { "box", Eigen::Isometry3d::Identity() } }, control_, &views).ok());
  EXPECT_EQ(views.views.size(), 12u);
  ASSERT_EQ(views.warnings.size(), 1u);
  EXPECT_NE(views.warnings[0].find("not known for 8 of 12 keyframes"), std::string::npos) << views.warnings[0];
}

TEST_F(BuildObject, FailureAlsoNamesTheKeyframesThatWereLeftOut)
{
  setSigma(*store_, "box", { 2, 5 }, 0.03, 0.001);
  BuildOptions options = coarse();
  options.fusion.min_views = 50;
  const BuildReport report = build({ "box" }, options);
  EXPECT_FALSE(report.status.ok());
  EXPECT_NE(report.status.message.find("which are left out"), std::string::npos) << report.status.message;
}

TEST_F(BuildObject, ViewsOfAllSessionsAreInTheReferenceFrame)
{
  storeRenderedSession(*store_, "more", 4);
  setColorOffset(*store_, "box", { 1, 0 });
  setColorOffset(*store_, "more", { -0.5, 0.25 });
  std::vector<keyframes::MaskUpdate> hidden{ { 1, cv::Mat() } };
  store_->update("more", keyframes::SessionChange::ofMasks(hidden));
  const Eigen::Isometry3d T_reference_more =
      Eigen::Translation3d(0.1, 0, -0.2) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());

  Views views;
  ASSERT_TRUE(
      loadViews(*store_, { { "box", Eigen::Isometry3d::Identity() }, { "more", T_reference_more } }, control_, &views)
          .ok());
  ASSERT_EQ(views.views.size(), 12u + 3u);
  ASSERT_EQ(views.origins.size(), views.views.size());
  for (std::size_t k = 0; k < views.views.size(); ++k)
  {
    const bool of_box = k < 12;
    const rgbd::View& view = views.views[k];
    const rgbd::Keyframe keyframe = store_->keyframe(views.origins[k].session_id, views.origins[k].keyframe_id);
    EXPECT_EQ(views.origins[k].session_id, of_box ? "box" : "more") << k;
    EXPECT_EQ(view.session_index, of_box ? 0 : 1) << k;
    EXPECT_EQ(view.color_offset_px, of_box ? Eigen::Vector2d(1, 0) : Eigen::Vector2d(-0.5, 0.25)) << k;
    EXPECT_TRANSFORM_NEAR(view.T_world_camera,
                          of_box ? keyframe.T_session_camera : T_reference_more * keyframe.T_session_camera, 1e-12,
                          1e-7);
  }
  EXPECT_EQ(views.origins[13].keyframe_id, 2) << "the one without a mask is left out";
}

}  // namespace object_modelling::pipeline
