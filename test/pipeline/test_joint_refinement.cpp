#include "joint_refinement.h"

#include <filesystem>

#include "build_fixture.h"
#include "object_modelling/geometry/transform.h"
#include "support/handheld_trajectory.h"

namespace object_modelling::pipeline
{
namespace
{
/// Views of the box from about one side, level with it: of its faces they see those towards them alone.
std::vector<rgbd::Keyframe> viewsFrom(double azimuth_rad, int count)
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
  for (const rgbd::Keyframe& keyframe : viewsFrom(azimuth_rad, count))
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
  JointRefinement joint;
  joint.session_ids = { "front", "back", "again" };
  std::vector<rgbd::Keyframe> keyframes;
  for (int session = 0; session < 3; ++session)
  {
    for (rgbd::Keyframe keyframe : viewsFrom(session == 1 ? M_PI : 0.1 * session, 3))
    {
      keyframe.id = static_cast<int>(keyframes.size());
      if (session > 0)
        keyframe.T_session_camera = geometry::isometryFromVector(off) * keyframe.T_session_camera;
      keyframes.push_back(keyframe);
      joint.sessions.push_back(session);
    }
  }
  const std::vector<rgbd::Keyframe> before = keyframes;
  base::JobControl control;
  const std::string message = refineJointly(joint, &keyframes, control);
  EXPECT_NE(message.find("'back'"), std::string::npos) << message;
  EXPECT_EQ(message.find("'front'"), std::string::npos) << message;
  EXPECT_EQ(message.find("'again'"), std::string::npos) << message;
  const auto moved = [&](std::size_t k)
  { return keyframes[k].T_session_camera.matrix() != before[k].T_session_camera.matrix(); };
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    EXPECT_EQ(moved(k), joint.sessions[k] == 2) << k;
}

}  // namespace object_modelling::pipeline
