#include <gtest/gtest.h>

#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/camera_conversion.h"
#include "object_modelling/ros_bridge/frame_conversion.h"

namespace object_modelling::ros_bridge
{
namespace
{
geometry::PinholeCamera rawCamera()
{
  geometry::PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 520;
  camera.fy = 521;
  camera.cx = 310.5;
  camera.cy = 240.25;
  camera.distortion = { 0.1, -0.2, 0.001, 0.002, 0.05 };
  return camera;
}

geometry::PinholeCamera rectifiedCamera()
{
  geometry::PinholeCamera camera = rawCamera();
  camera.distortion.clear();
  camera.fx = 500;
  camera.cx = 319.5;
  return camera;
}

std::string refusal(const sensor_msgs::CameraInfo& info, ImageKind kind)
{
  try
  {
    fromMessage(info, kind);
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(base::StatusCode::BAD_INPUT, error.code());
    return error.what();
  }
  return "nothing was refused";
}

TEST(CameraConversion, RoundTripOfBothImages)
{
  const sensor_msgs::CameraInfo info = toMessage(rawCamera(), rectifiedCamera(), std_msgs::Header());
  EXPECT_TRUE(rectifiedCamera() == fromMessage(info, ImageKind::RECTIFIED));
  EXPECT_TRUE(rawCamera() == fromMessage(info, ImageKind::RAW));
}

TEST(CameraConversion, RationalModel)
{
  geometry::PinholeCamera camera = rawCamera();
  camera.distortion = { 0.1, -0.2, 0.001, 0.002, 0.05, 0.3, 0.2, 0.1 };
  const sensor_msgs::CameraInfo info = toMessage(camera, rectifiedCamera(), std_msgs::Header());
  EXPECT_EQ("rational_polynomial", info.distortion_model);
  EXPECT_TRUE(camera == fromMessage(info, ImageKind::RAW));
}

TEST(CameraConversion, DistortionDoesNotTouchTheRectifiedImage)
{
  sensor_msgs::CameraInfo info = toMessage(rawCamera(), rectifiedCamera(), std_msgs::Header());
  info.distortion_model = "equidistant";
  EXPECT_FALSE(fromMessage(info, ImageKind::RECTIFIED).distorted());
  EXPECT_NE(std::string::npos, refusal(info, ImageKind::RAW).find("\"equidistant\""));
}

TEST(CameraConversion, UncalibratedCameraIsRefused)
{
  sensor_msgs::CameraInfo info;
  info.header.frame_id = "cam";
  EXPECT_NE(std::string::npos, refusal(info, ImageKind::RECTIFIED).find("\"cam\""));
  EXPECT_NE(std::string::npos, refusal(info, ImageKind::RAW).find("focal length is 0"));
}

TEST(CameraConversion, MissingPIsReadFromKWithoutDistortion)
{
  sensor_msgs::CameraInfo info = toMessage(rectifiedCamera(), rectifiedCamera(), std_msgs::Header());
  info.P.fill(0);
  EXPECT_TRUE(rectifiedCamera() == fromMessage(info, ImageKind::RECTIFIED));
  info = toMessage(rawCamera(), rectifiedCamera(), std_msgs::Header());
  info.P.fill(0);
  EXPECT_NE(std::string::npos, refusal(info, ImageKind::RECTIFIED).find("no P"));
}

TEST(CameraConversion, BinningAndRegion)
{
  sensor_msgs::CameraInfo info = toMessage(rectifiedCamera(), rectifiedCamera(), std_msgs::Header());
  info.roi.x_offset = 100;
  info.roi.y_offset = 40;
  info.roi.width = 400;
  info.roi.height = 200;
  info.binning_x = info.binning_y = 2;
  const geometry::PinholeCamera camera = fromMessage(info, ImageKind::RECTIFIED);
  EXPECT_EQ(200, camera.width);
  EXPECT_EQ(100, camera.height);
  EXPECT_DOUBLE_EQ(250, camera.fx);
  EXPECT_DOUBLE_EQ((319.5 - 100) / 2, camera.cx);
}

TEST(FrameConversion, UnregisteredDepthIsNoticed)
{
  std_msgs::Header color, depth;
  color.frame_id = "rgb_optical";
  depth.frame_id = "rgb_optical";
  EXPECT_TRUE(checkRegistered(color, depth).ok());
  depth.frame_id = "ir_optical";
  EXPECT_NE(std::string::npos, checkRegistered(color, depth).message.find("ir_optical"));
}
}  // namespace
}  // namespace object_modelling::ros_bridge
