#include <gtest/gtest.h>

#include "nodes/keyframe_store/session_preview.h"

namespace object_modelling::nodes
{
namespace
{
constexpr int WIDTH = 40, HEIGHT = 30;

rgbd::Keyframe keyframeAt(int id, double x_m)
{
  rgbd::Keyframe keyframe;
  keyframe.id = id;
  keyframe.frame.stamp_s = id;
  keyframe.frame.camera.width = WIDTH;
  keyframe.frame.camera.height = HEIGHT;
  keyframe.frame.camera.fx = keyframe.frame.camera.fy = 40;
  keyframe.frame.camera.cx = 19.5;
  keyframe.frame.camera.cy = 14.5;
  keyframe.frame.color_bgr = cv::Mat(HEIGHT, WIDTH, CV_8UC3, cv::Scalar(1, 2, 3));
  keyframe.frame.depth_m = cv::Mat(HEIGHT, WIDTH, CV_32FC1, cv::Scalar(1));
  keyframe.frame.depth_m.at<float>(0, 0) = std::numeric_limits<float>::quiet_NaN();
  keyframe.T_session_camera.translation().x() = x_m;
  return keyframe;
}

cv::Mat maskOfOnePixel()
{
  cv::Mat mask = cv::Mat::zeros(HEIGHT, WIDTH, CV_8UC1);
  mask.at<std::uint8_t>(10, 20) = 255;
  return mask;
}

TEST(SessionPreview, OnePointPerVoxelInTheSessionFrame)
{
  SessionPreview preview{ SessionPreviewOptions() };
  preview.show("s");
  preview.add(keyframeAt(0, 0));
  const SessionPreview::Cloud cloud = preview.cloud();
  EXPECT_EQ(WIDTH * HEIGHT - 1u, cloud.points_session.size());  // 25 mm apart; one has no depth
  EXPECT_EQ(SessionPreview::Color(3, 2, 1), cloud.colors_rgb.front());
  preview.add(keyframeAt(1, 0));  // the same again
  EXPECT_EQ(cloud.points_session.size(), preview.cloud().points_session.size());
  preview.move({ { 1, keyframeAt(1, 10).T_session_camera, geometry::Matrix6d::Zero() } });
  EXPECT_EQ(2 * cloud.points_session.size(), preview.cloud().points_session.size());
  EXPECT_EQ(10, preview.views()[1].T_session_camera.translation().x());
}

TEST(SessionPreview, TheObjectAloneOnceThereAreMasks)
{
  SessionPreview preview{ SessionPreviewOptions() };
  preview.show("s");
  preview.add(keyframeAt(0, 0));
  preview.add(keyframeAt(1, 10));
  preview.mask({ { 1, maskOfOnePixel() } });
  ASSERT_EQ(1u, preview.cloud().points_session.size());
  EXPECT_NEAR(10 + 0.5 / 40, preview.cloud().points_session[0].x(), 1e-5);
  preview.mask({ { 1, {} } });
  EXPECT_GT(preview.cloud().points_session.size(), 1000u);
}

TEST(SessionPreview, IsBounded)
{
  SessionPreviewOptions options;
  options.max_points = 1500;
  options.max_keyframes = 2;
  SessionPreview preview(options);
  preview.show("s");
  for (int i = 0; i < 3; ++i)
    preview.add(keyframeAt(i, 10 * i));
  EXPECT_EQ(1500u, preview.cloud().points_session.size());
  EXPECT_EQ(3u, preview.views().size());
  preview.show("");
  EXPECT_TRUE(preview.cloud().points_session.empty());
}

TEST(SessionPreview, UnknownKeyframesAreIgnored)
{
  SessionPreview preview{ SessionPreviewOptions() };
  preview.move({ { 5, Eigen::Isometry3d::Identity(), geometry::Matrix6d::Zero() } });
  preview.mask({ { 5, maskOfOnePixel() } });
  EXPECT_TRUE(preview.views().empty());
}
}  // namespace
}  // namespace object_modelling::nodes
