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
}  // namespace

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
