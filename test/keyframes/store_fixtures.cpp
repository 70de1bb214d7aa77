#include "store_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace object_modelling::keyframes
{
namespace
{
bool identical(const cv::Mat& a, const cv::Mat& b)
{
  if (a.size() != b.size() || (!a.empty() && a.type() != b.type()))
    return false;
  return a.empty() || cv::norm(a, b, cv::NORM_INF) == 0;
}
}  // namespace

rgbd::Keyframe makeKeyframe(int id, int width, int height)
{
  rgbd::Keyframe keyframe;
  keyframe.id = id;
  rgbd::Frame& frame = keyframe.frame;
  frame.stamp_s = 1700000000.123456 + 0.1 * id;
  frame.camera.width = width;
  frame.camera.height = height;
  frame.camera.fx = 525.1;
  frame.camera.fy = 524.9;
  frame.camera.cx = width / 2.0 + 1.0 / 3;
  frame.camera.cy = height / 2.0 - 1.0 / 7;
  frame.color_bgr.create(height, width, CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(id) + 1);
  random.fill(frame.color_bgr, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(frame.color_bgr, frame.color_bgr, cv::Size(5, 5), 0);
  cv::cvtColor(frame.color_bgr, frame.gray, cv::COLOR_BGR2GRAY);
  frame.depth_m.create(height, width, CV_32FC1);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      frame.depth_m.at<float>(v, u) =
          (u + v) % 7 == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.5f + 0.00123f * u + 0.00071f * v + 0.01f * id;
  frame.object_mask = cv::Mat::zeros(height, width, CV_8UC1);
  cv::circle(frame.object_mask, { width / 2, height / 2 }, height / 4, cv::Scalar(255), cv::FILLED);
  frame.moving_mask = frame.object_mask.clone();
  frame.moving_mask.rowRange(height / 2, height).setTo(255);
  keyframe.T_session_camera = Eigen::Translation3d(0.1 * id, 1.0 / 3, -0.7) *
                              Eigen::AngleAxisd(0.3 * id + 0.1, Eigen::Vector3d(1, 2, 3).normalized());
  keyframe.covariance.diagonal() << 1e-6, 2e-6, 3e-6, 1e-5, 2e-5, 1.0 / 3e5;
  keyframe.observations = {
    { 0xfedcba9876543210u, { 1.25f, 2.5f }, 0.75f },
    { static_cast<std::uint64_t>(id), { 30.1f, 7.9f }, std::numeric_limits<float>::quiet_NaN() }
  };
  return keyframe;
}

Session makeSession(const std::string& id)
{
  Session session;
  session.id = id;
  session.object_id = "cup";
  session.camera_frame_id = "camera_rgb_optical_frame";
  return session;
}

rgbd::SensorCalibration makeCalibration()
{
  rgbd::SensorCalibration calibration;
  calibration.noise_model.axial_constant_m = 0.001 + 1.0 / 3e4;
  calibration.noise_model.axial_quadratic_per_m = 0.0031;
  calibration.noise_model.lateral_constant_px = 0.9;
  calibration.noise_model.depth_bias_linear_ratio = -0.0012;
  calibration.noise_model.depth_distortion_ratio[5] = 1.0 / 7000;
  calibration.color_offset_px = { 1.0 / 3, -0.125 };
  return calibration;
}

double depthDifference_m(const cv::Mat& a, const cv::Mat& b)
{
  if (a.size() != b.size() || a.type() != CV_32FC1 || b.type() != CV_32FC1)
    return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (int v = 0; v < a.rows; ++v)
    for (int u = 0; u < a.cols; ++u)
    {
      const float first = a.at<float>(v, u), second = b.at<float>(v, u);
      if (std::isnan(first) != std::isnan(second))
        return std::numeric_limits<double>::infinity();
      if (!std::isnan(first))
        largest = std::max(largest, static_cast<double>(std::abs(first - second)));
    }
  return largest;
}

void expectSame(const rgbd::Keyframe& actual, const rgbd::Keyframe& expected)
{
  EXPECT_EQ(actual.id, expected.id);
  EXPECT_EQ(actual.frame.stamp_s, expected.frame.stamp_s);
  EXPECT_TRUE(actual.frame.camera == expected.frame.camera);
  EXPECT_TRUE(identical(actual.frame.color_bgr, expected.frame.color_bgr)) << "colour of keyframe " << expected.id;
  EXPECT_TRUE(identical(actual.frame.gray, expected.frame.gray)) << "gray of keyframe " << expected.id;
  EXPECT_TRUE(identical(actual.frame.object_mask, expected.frame.object_mask)) << "mask of keyframe " << expected.id;
  EXPECT_TRUE(identical(actual.frame.moving_mask, expected.frame.moving_mask)) << "keyframe " << expected.id;
  EXPECT_EQ(actual.T_session_camera.matrix(), expected.T_session_camera.matrix());
  EXPECT_EQ(actual.covariance, expected.covariance);
  ASSERT_EQ(actual.observations.size(), expected.observations.size());
  for (std::size_t i = 0; i < expected.observations.size(); ++i)
  {
    EXPECT_EQ(actual.observations[i].landmark_id, expected.observations[i].landmark_id);
    EXPECT_EQ(actual.observations[i].pixel, expected.observations[i].pixel);
    const float depth_m = expected.observations[i].depth_m;
    EXPECT_TRUE(std::isnan(depth_m) ? std::isnan(actual.observations[i].depth_m)
                                    : actual.observations[i].depth_m == depth_m);
  }
}

}  // namespace object_modelling::keyframes
