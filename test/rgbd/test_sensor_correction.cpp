#include "object_modelling/rgbd/sensor_correction.h"

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

}  // namespace object_modelling::rgbd
