#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/session_conversion.h"
#include "object_modelling/ros_bridge/status_conversion.h"
#include "object_modelling/ros_bridge/time_conversion.h"

namespace object_modelling::ros_bridge
{
namespace
{
Eigen::Isometry3d somePose()
{
  return geometry::isometryFrom(Eigen::Quaterniond(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 0.5).normalized())),
                                { 0.1, -0.2, 0.3 });
}

rgbd::Keyframe someKeyframe()
{
  rgbd::Keyframe keyframe;
  keyframe.id = 7;
  keyframe.frame.stamp_s = 1234.5678;
  keyframe.frame.camera.width = 8;
  keyframe.frame.camera.height = 6;
  keyframe.frame.camera.fx = keyframe.frame.camera.fy = 10;
  keyframe.frame.camera.cx = 3.5;
  keyframe.frame.camera.cy = 2.5;
  keyframe.frame.color_bgr.create(6, 8, CV_8UC3);
  cv::randu(keyframe.frame.color_bgr, 0, 256);
  cv::cvtColor(keyframe.frame.color_bgr, keyframe.frame.gray, cv::COLOR_BGR2GRAY);
  keyframe.frame.depth_m = cv::Mat(6, 8, CV_32FC1, cv::Scalar(0.75));
  keyframe.frame.depth_m.at<float>(0, 0) = NAN;
  keyframe.frame.object_mask = cv::Mat(6, 8, CV_8UC1, cv::Scalar(0));
  keyframe.frame.object_mask.at<std::uint8_t>(3, 3) = 255;
  keyframe.frame.moving_mask = cv::Mat(6, 8, CV_8UC1, cv::Scalar(0));
  keyframe.frame.moving_mask.rowRange(3, 5).setTo(255);
  keyframe.T_session_camera = somePose();
  keyframe.covariance = geometry::Matrix6d::Identity() * 1e-4;
  keyframe.covariance(0, 5) = keyframe.covariance(5, 0) = 3e-5;
  keyframe.observations = { { std::numeric_limits<std::uint64_t>::max(), { 1.25f, 2.5f }, 0.75f },
                            { 2, { 3, 4 }, NAN } };
  return keyframe;
}

TEST(KeyframeConversion, RoundTrip)
{
  const rgbd::Keyframe keyframe = someKeyframe();
  const object_modelling::Keyframe message = toMessage(keyframe, "s1", "cam");
  EXPECT_EQ("s1", message.session_id);
  EXPECT_EQ("cam", message.header.frame_id);
  const rgbd::Keyframe back = fromMessage(message);
  EXPECT_EQ(7, back.id);
  EXPECT_NEAR(keyframe.frame.stamp_s, back.frame.stamp_s, 1e-9);
  EXPECT_TRUE(keyframe.frame.camera == back.frame.camera);
  EXPECT_EQ(0, cv::norm(keyframe.frame.color_bgr, back.frame.color_bgr, cv::NORM_INF));
  EXPECT_EQ(0, cv::norm(keyframe.frame.gray, back.frame.gray, cv::NORM_INF));
  EXPECT_EQ(0, cv::norm(keyframe.frame.object_mask, back.frame.object_mask, cv::NORM_INF));
  EXPECT_EQ(0, cv::norm(keyframe.frame.moving_mask, back.frame.moving_mask, cv::NORM_INF));
  EXPECT_TRUE(std::isnan(back.frame.depth_m.at<float>(0, 0)));
  EXPECT_EQ(0.75f, back.frame.depth_m.at<float>(5, 7));
  EXPECT_TRUE(back.T_session_camera.isApprox(keyframe.T_session_camera, 1e-12));
  EXPECT_TRUE(back.covariance.isApprox(keyframe.covariance));
  ASSERT_EQ(2u, back.observations.size());
  EXPECT_EQ(keyframe.observations[0].landmark_id, back.observations[0].landmark_id);
  EXPECT_EQ(keyframe.observations[0].pixel, back.observations[0].pixel);
  EXPECT_TRUE(std::isnan(back.observations[1].depth_m));
}

TEST(KeyframeConversion, MasksMayBeMissing)
{
  rgbd::Keyframe keyframe = someKeyframe();
  keyframe.frame.moving_mask.release();
  EXPECT_TRUE(fromMessage(toMessage(keyframe, "s1", "cam")).frame.moving_mask.empty());
  keyframe.frame.object_mask.release();
  EXPECT_TRUE(fromMessage(toMessage(keyframe, "s1", "cam")).frame.object_mask.empty());
}

TEST(KeyframeConversion, DepthMayComeInMillimeters)
{
  object_modelling::Keyframe message = toMessage(someKeyframe(), "s1", "cam");
  message.depth.encoding = "16UC1";
  message.depth.step = 16;
  message.depth.data.assign(16 * 6, 0);
  message.depth.data[0] = 0xe8;
  message.depth.data[1] = 0x03;
  const rgbd::Keyframe back = fromMessage(message);
  EXPECT_FLOAT_EQ(1.0f, back.frame.depth_m.at<float>(0, 0));
  EXPECT_TRUE(std::isnan(back.frame.depth_m.at<float>(0, 1)));
}

TEST(KeyframeConversion, PartsOfDifferentSizeAreRefused)
{
  object_modelling::Keyframe message = toMessage(someKeyframe(), "s1", "cam");
  message.camera_info.width = 9;
  EXPECT_THROW(fromMessage(message), base::Error);
  message = toMessage(someKeyframe(), "s1", "cam");
  message.session_from_camera.pose.orientation.w += 1;
  EXPECT_THROW(fromMessage(message), base::Error);
  rgbd::Keyframe keyframe = someKeyframe();
  keyframe.frame.moving_mask = keyframe.frame.moving_mask.rowRange(0, 3);
  EXPECT_THROW(fromMessage(toMessage(keyframe, "s1", "cam")), base::Error);
  EXPECT_THROW(fromMessage(object_modelling::Keyframe()), base::Error);
}

TEST(KeyframeConversion, Masks)
{
  const keyframes::MaskUpdate update{ 3, cv::Mat(2, 2, CV_8UC1, cv::Scalar(255)) };
  const object_modelling::ObjectMask message = toMessage(update, "s1");
  EXPECT_EQ("s1", message.session_id);
  EXPECT_EQ(3, fromMessage(message).keyframe_id);
  EXPECT_EQ(4, cv::countNonZero(fromMessage(message).object_mask));
  EXPECT_TRUE(fromMessage(toMessage(keyframes::MaskUpdate{ 3, {} }, "s1")).object_mask.empty());
}

TEST(SessionConversion, RoundTrip)
{
  keyframes::Session session;
  session.id = "s1";
  session.object_id = "mug";
  session.camera_frame_id = "cam";
  session.started_s = 12.5;
  session.keyframe_count = 4;
  session.reference_is_object = true;
  session.closed = true;
  keyframes::Session back = fromMessage(toMessage(session));
  EXPECT_EQ("s1", back.id);
  EXPECT_EQ("mug", back.object_id);
  EXPECT_EQ("cam", back.camera_frame_id);
  EXPECT_EQ(12.5, back.started_s);
  EXPECT_EQ(4, back.keyframe_count);
  EXPECT_TRUE(back.reference_is_object);
  EXPECT_TRUE(back.closed);
  EXPECT_FALSE(back.support_plane_session);
  EXPECT_FALSE(back.T_model_session);
  EXPECT_TRUE(back.calibration == rgbd::SensorCalibration());
  EXPECT_TRUE(fromMessage(object_modelling::Session()).calibration == rgbd::SensorCalibration());

  session.calibration.noise_model.axial_quadratic_per_m = 0.003;
  session.calibration.noise_model.depth_distortion_ratio[62] = 0.001;
  session.calibration.correction.depth_distortion_ratio[5] = -0.002;
  session.calibration.color_offset_px = { 0.25, -0.5 };
  session.refinement_report = "refined";
  geometry::Plane plane;
  plane.normal = Eigen::Vector3d(0, 0.6, -0.8);
  plane.offset_m = 0.7;
  session.support_plane_session = plane;
  session.T_model_session = somePose();
  back = fromMessage(toMessage(session));
  ASSERT_TRUE(back.support_plane_session);
  EXPECT_EQ(plane.normal, back.support_plane_session->normal);
  EXPECT_EQ(0.7, back.support_plane_session->offset_m);
  EXPECT_TRUE(back.calibration == session.calibration);
  EXPECT_EQ(back.refinement_report, "refined");
  ASSERT_TRUE(back.T_model_session);
  EXPECT_TRUE(back.T_model_session->isApprox(somePose(), 1e-12));
}

TEST(SessionConversion, UnusablePartsAreRefused)
{
  object_modelling::Session message = toMessage(keyframes::Session());
  message.has_support_plane = true;
  message.support_plane.normal.z = 3;
  EXPECT_THROW(fromMessage(message), base::Error);
  message = toMessage(keyframes::Session());
  message.has_model_from_session = true;
  message.model_from_session = geometry_msgs::Pose();
  EXPECT_THROW(fromMessage(message), base::Error);
  message = toMessage(keyframes::Session());
  message.calibration.noise_model.axial_constant_m = 0;
  EXPECT_THROW(fromMessage(message), base::Error);
  message = toMessage(keyframes::Session());
  message.calibration.noise_model.depth_distortion_ratio = { 1, 2 };
  EXPECT_THROW(fromMessage(message), base::Error);
  message = toMessage(keyframes::Session());
  message.calibration.depth_distortion_ratio.assign(rgbd::DistortionGrid::KNOTS, NAN);
  EXPECT_THROW(fromMessage(message), base::Error);
}

TEST(StatusConversion, EveryCode)
{
  for (int code = 0; code <= static_cast<int>(base::StatusCode::INTERNAL); ++code)
  {
    const base::Status status(static_cast<base::StatusCode>(code), "text");
    EXPECT_EQ(code, toMessage(status).code);
    EXPECT_EQ(status.code, fromMessage(toMessage(status)).code);
  }
  object_modelling::Status unknown;
  unknown.code = 200;
  EXPECT_EQ(base::StatusCode::INTERNAL, fromMessage(unknown).code);
  EXPECT_NE(std::string::npos, fromMessage(unknown).message.find("200"));
}

TEST(StatusConversion, WhateverIsThrownBecomesAStatus)
{
  EXPECT_TRUE(guarded([] {}).ok());
  EXPECT_EQ(base::StatusCode::STORAGE, guarded([] { throw base::Error(base::StatusCode::STORAGE, "full"); }).code);
  EXPECT_EQ(base::StatusCode::INTERNAL, guarded([] { throw std::runtime_error("x"); }).code);
}

TEST(TimeConversion, RoundTripAndAbsurdValues)
{
  EXPECT_EQ(ros::Time(12, 500000000), toTime(12.5));
  EXPECT_EQ(ros::Time(13, 0), toTime(12.9999999999));
  EXPECT_TRUE(toTime(-1).isZero());
  EXPECT_TRUE(toTime(NAN).isZero());
  EXPECT_TRUE(toTime(1e30).isZero());
  const ros::Time stamp(1763000000, 123456789);
  EXPECT_NEAR(0, (toTime(toSeconds(stamp)) - stamp).toSec(), 3e-7);
}
}  // namespace
}  // namespace object_modelling::ros_bridge
