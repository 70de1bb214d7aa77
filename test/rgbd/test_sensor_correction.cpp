#include "object_modelling/rgbd/corrected.h"

#include <cmath>

#include <gtest/gtest.h>

namespace object_modelling::rgbd
{
TEST(SensorCorrection, correctsCameraAndDepthAndSharesTheRest)
{
  Frame frame;
  frame.gray = cv::Mat(2, 3, CV_8UC1, cv::Scalar(7));
  frame.depth_m = (cv::Mat_<float>(2, 3) << 1, 2, NAN, 0.5F, 1, 1);
  frame.camera.fx = frame.camera.fy = 500;
  SensorCorrection sensor;
  EXPECT_TRUE(sensor.isIdentity());
  EXPECT_EQ(corrected(frame, sensor).depth_m.data, frame.depth_m.data);
  sensor.focal_ratio.x() = 1.01;
  sensor.depth_ratio = 1.02;
  sensor.depth_offset_m = -0.001;
  EXPECT_FALSE(sensor.isIdentity());
  const Frame right = corrected(frame, sensor);
  EXPECT_EQ(right.gray.data, frame.gray.data);
  EXPECT_DOUBLE_EQ(right.camera.fx, 505);
  EXPECT_DOUBLE_EQ(right.camera.fy, 500);
  EXPECT_FLOAT_EQ(right.depthAt_m(1, 0), 2.039F);
  EXPECT_TRUE(std::isnan(right.depthAt_m(2, 0)));
  EXPECT_FLOAT_EQ(frame.depthAt_m(1, 0), 2);
}

TEST(SensorCorrection, takesDistortionOffWhereItIs)
{
  Frame frame;
  frame.depth_m = cv::Mat(7, 9, CV_32FC1, cv::Scalar(2));  // a knot a pixel
  frame.depth_m.at<float>(3, 4) = NAN;
  SensorCorrection sensor;
  sensor.depth_distortion_ratio[2 * DistortionGrid::COLUMNS + 5] = 0.01;
  EXPECT_FALSE(sensor.isIdentity());
  const Frame right = corrected(frame, sensor);
  EXPECT_FLOAT_EQ(right.depthAt_m(5, 2), 1.98F);
  EXPECT_FLOAT_EQ(right.depthAt_m(6, 2), 2);
  EXPECT_TRUE(std::isnan(right.depthAt_m(4, 3)));
  EXPECT_FLOAT_EQ(frame.depthAt_m(5, 2), 2);
}

TEST(SensorCorrection, OneAfterTheOtherIsOne)
{
  Keyframe keyframe;
  keyframe.frame.depth_m = (cv::Mat_<float>(1, 1) << 0.8F);
  keyframe.frame.camera.fx = keyframe.frame.camera.fy = 500;
  keyframe.frame.camera.cx = 320;
  keyframe.observations.push_back({ 3, { 10, 20 }, 0.7F });
  SensorCorrection first, second;
  first.focal_ratio = { 1.01, 0.98 };
  first.principal_shift_px = { 2, -1 };
  first.depth_ratio = 1.02;
  first.depth_offset_m = 0.003;
  second.focal_ratio = { 0.995, 1.002 };
  second.principal_shift_px = { 0.5, 0.25 };
  second.depth_ratio = 0.99;
  second.depth_offset_m = -0.001;
  keyframe.frame.camera.width = keyframe.frame.camera.height = 1;
  first.depth_distortion_ratio.fill(0.0004);
  second.depth_distortion_ratio.fill(-0.001);
  const Keyframe stepwise = corrected(corrected(keyframe, first), second);
  const Keyframe at_once = corrected(keyframe, first.then(second));
  EXPECT_NEAR(at_once.frame.camera.fx, stepwise.frame.camera.fx, 1e-9);
  EXPECT_NEAR(at_once.frame.camera.fy, stepwise.frame.camera.fy, 1e-9);
  EXPECT_NEAR(at_once.frame.camera.cx, stepwise.frame.camera.cx, 1e-9);
  EXPECT_NEAR(at_once.frame.camera.cy, stepwise.frame.camera.cy, 1e-9);
  EXPECT_NEAR(at_once.frame.depthAt_m(0, 0), stepwise.frame.depthAt_m(0, 0), 4e-6);
  EXPECT_NEAR(at_once.observations[0].depth_m, stepwise.observations[0].depth_m, 4e-6);
  EXPECT_TRUE(first.then({}) == first);
}

}  // namespace object_modelling::rgbd
