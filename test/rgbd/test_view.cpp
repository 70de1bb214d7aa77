#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/rgbd/keyframe_view.h"
#include "support/thrown_status.h"
#include "support/transform_matchers.h"

namespace object_modelling::rgbd
{
namespace
{
Keyframe keyframe()
{
  Keyframe keyframe;
  keyframe.id = 7;
  keyframe.frame.depth_m = cv::Mat(4, 6, CV_32FC1, cv::Scalar(1));
  keyframe.T_session_camera = Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  keyframe.covariance.diagonal() << 1e-6, 4e-6, 9e-6, 1e-4, 2e-4, 3e-4;
  return keyframe;
}
}  // namespace

TEST(View, OfAKeyframeIsInTheWorldThatIsAskedFor)
{
  const Eigen::Isometry3d T_world_session =
      Eigen::Translation3d(1, 0, -2) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const Keyframe of = keyframe();
  const View view = viewOf(of, T_world_session, 3, { 0.25, -0.5 });
  EXPECT_EQ(view.frame.depth_m.data, of.frame.depth_m.data) << "images are shared";
  EXPECT_TRANSFORM_NEAR(view.T_world_camera, T_world_session * of.T_session_camera, 1e-12, 1e-12);
  EXPECT_EQ(view.session_index, 3);
  EXPECT_EQ(view.color_offset_px, Eigen::Vector2d(0.25, -0.5));
  // Turned by 90 degrees about z, x and y change places; rotations move what is 2 m off the world's origin.
  EXPECT_NEAR(view.covariance(3, 3), 2e-4, 1e-12);
  EXPECT_NEAR(view.covariance(4, 4), 1e-4, 1e-12);
  EXPECT_NEAR(view.covariance(5, 5), 3e-4, 1e-12);
  EXPECT_NEAR(view.covariance(0, 0), 4e-6 + 4 * 1e-4, 1e-12);
  EXPECT_NEAR(view.covariance(2, 2), 9e-6 + 1e-4, 1e-12);
}

TEST(View, OfOneSessionAreInItsFrameToTheBit)
{
  const std::vector<Keyframe> keyframes{ keyframe(), keyframe() };
  const std::vector<View> views = viewsOf(keyframes, { 1, 2 });
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[1].T_world_camera.matrix(), keyframes[1].T_session_camera.matrix());
  EXPECT_EQ(views[1].covariance, keyframes[1].covariance);
  EXPECT_EQ(views[1].session_index, 0);
  EXPECT_EQ(views[1].color_offset_px, Eigen::Vector2d(1, 2));
}

TEST(View, ThatIsNotPlacedIsNamed)
{
  checkPlaced({});
  const std::vector<View> good(3);
  checkPlaced(good);
  const auto expectNamed = [&](const View& bad)
  {
    EXPECT_FALSE(isPlaced(bad));
    std::vector<View> views = good;
    views[1] = bad;
    const base::Status status = test_support::statusOf([&] { checkPlaced(views); });
    EXPECT_EQ(status.code, base::StatusCode::INVALID_ARGUMENT);
    EXPECT_TRUE(test_support::mentions(status, "view 1 is not placed")) << status.message;
  };
  View pose, offset, session;
  pose.T_world_camera.translation().x() = std::nan("");
  offset.color_offset_px.y() = INFINITY;
  session.session_index = -1;
  for (const View& bad : { pose, offset, session })
    expectNamed(bad);
}

}  // namespace object_modelling::rgbd
