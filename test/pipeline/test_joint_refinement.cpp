#include "joint_refinement.h"

#include <filesystem>

#include "build_fixture.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/keyframe_view.h"
#include "support/handheld_trajectory.h"

namespace object_modelling::pipeline
{
namespace
{
/// From about one side of the box, level with it: of its faces they see those towards them alone.
std::vector<rgbd::Keyframe> keyframesFrom(double azimuth_rad, int count)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back(test_support::orbitPose({ 0, 0, 0.1 }, 0.6, azimuth_rad + 0.2 * (i - 0.5 * (count - 1)), 0.0));
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 0.5;
  noise.missing_edge_px = 1;
  return test_support::renderKeyframes(test_support::boxOnTable(), smallCamera(), poses, noise);
}

void storeViews(keyframes::SessionStore& store, const std::string& session_id, double azimuth_rad, int count)
{
  keyframes::Session session = named(session_id);
  session.camera_frame_id = "camera_optical";
  session.closed = true;
  session.support_plane_session = geometry::Plane{ Eigen::Vector3d::UnitZ(), 0 };
  store.createSession(session);
  for (const rgbd::Keyframe& keyframe : keyframesFrom(azimuth_rad, count))
    store.addKeyframe(session_id, keyframe);
}
}  // namespace

TEST_F(BuildObject, SessionsWithNothingInCommonAreModelledAsAligned)
{
  storeViews(*store_, "front", 0, 3);
  storeViews(*store_, "back", M_PI, 3);
  const BuildReport report = build({ "front", "back" });
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_NE(report.status.message.find("placed as aligned"), std::string::npos) << report.status.message;
  EXPECT_TRUE(std::filesystem::exists(report.preview_path));
}

TEST(JointRefinement, NamesTheSessionsThatNothingLinks)
{
  geometry::Vector6d off;
  off << 0.001, -0.001, 0.001, 0.002, -0.002, 0.004;
  std::vector<rgbd::View> views;
  for (int session = 0; session < 3; ++session)
  {
    const Eigen::Isometry3d T_world_session =
        session > 0 ? geometry::isometryFromVector(off) : Eigen::Isometry3d::Identity();
    for (const rgbd::Keyframe& keyframe : keyframesFrom(session == 1 ? M_PI : 0.1 * session, 3))
      views.push_back(rgbd::viewOf(keyframe, T_world_session, session, { 0, 0 }));
  }
  const std::vector<rgbd::View> before = views;
  base::JobControl control;
  const std::string message = refineJointly({ "front", "back", "again" }, &views, control);
  EXPECT_NE(message.find("'back'"), std::string::npos) << message;
  EXPECT_EQ(message.find("'front'"), std::string::npos) << message;
  EXPECT_EQ(message.find("'again'"), std::string::npos) << message;
  const auto moved = [&](std::size_t k)
  { return views[k].T_world_camera.matrix() != before[k].T_world_camera.matrix(); };
  for (std::size_t k = 0; k < views.size(); ++k)
    EXPECT_EQ(moved(k), views[k].session_index == 2) << k;
}

}  // namespace object_modelling::pipeline
