#include "object_modelling/rgbd/frame_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "support/synthetic_scene.h"
#include "support/violations.h"

namespace object_modelling::rgbd
{
namespace
{
RawFrame goodFrame()
{
  RawFrame raw;
  raw.stamp_s = 1000;
  raw.depth_stamp_s = 1000.005;
  raw.camera = test_support::vgaCamera();
  raw.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(10, 100, 200));
  raw.depth = cv::Mat(480, 640, CV_16UC1, cv::Scalar(1500));
  return raw;
}

void expectRefused(const RawFrame& raw, const std::string& words)
{
  const base::Result<Frame> result = FrameBuilder().build(raw);
  EXPECT_EQ(result.status.code, base::StatusCode::BAD_INPUT);
  EXPECT_NE(result.status.message.find(words), std::string::npos) << result.status.message;
}

TEST(FrameBuilder, RectifiedColorIsSharedNotCopied)
{
  RawFrame raw = goodFrame();
  raw.camera.distortion = { 0, 0, 0, 0, 0 };
  const base::Result<Frame> result = FrameBuilder().build(raw);
  ASSERT_TRUE(result.ok()) << result.status.message;
  const Frame& frame = result.value;
  EXPECT_EQ(frame.color_bgr.data, raw.color.data);
  EXPECT_EQ(frame.stamp_s, 1000);
  EXPECT_NEAR(frame.depth_delay_s, 0.005, 1e-9);
  EXPECT_EQ(frame.gray.at<std::uint8_t>(10, 10), 120);  // 0.114 B + 0.587 G + 0.299 R
  EXPECT_FLOAT_EQ(frame.depthAt_m(5, 7), 1.5f);
  EXPECT_TRUE(frame.object_mask.empty());
  EXPECT_TRUE(frame.camera.distortion.empty());
}

TEST(FrameBuilder, GrayImageServesAsBoth)
{
  RawFrame raw = goodFrame();
  raw.color = cv::Mat(480, 640, CV_8UC1, cv::Scalar(77));
  const base::Result<Frame> result = FrameBuilder().build(raw);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.value.gray.data, raw.color.data);
  EXPECT_EQ(result.value.color_bgr.at<cv::Vec3b>(3, 3), cv::Vec3b(77, 77, 77));
}

TEST(FrameBuilder, FloatDepthAndRange)
{
  RawFrame raw = goodFrame();
  raw.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2.0f));
  raw.depth.at<float>(0, 0) = 0.05f;
  raw.depth.at<float>(0, 1) = 9.0f;
  raw.depth.at<float>(0, 2) = std::numeric_limits<float>::infinity();
  const base::Result<Frame> result = FrameBuilder().build(raw);
  ASSERT_TRUE(result.ok());
  for (int u = 0; u < 3; ++u)
    EXPECT_TRUE(std::isnan(result.value.depthAt_m(u, 0))) << u;
  EXPECT_FLOAT_EQ(result.value.depthAt_m(3, 0), 2.0f);
  EXPECT_FLOAT_EQ(raw.depth.at<float>(0, 1), 9.0f);  // the sensor's image stays as it was
}

TEST(FrameBuilder, TakesTheBiasOffTheDepth)
{
  RawFrame raw = goodFrame();
  raw.depth = cv::Mat(raw.color.size(), CV_16UC1, cv::Scalar(2000));
  raw.depth.at<std::uint16_t>(0, 0) = 0;
  FrameBuilderOptions options;
  options.noise_model.depth_bias_constant_m = 0.001;
  options.noise_model.depth_bias_linear_ratio = -0.002;
  options.noise_model.depth_bias_quadratic_per_m = 0.003;
  options.noise_model.depth_distortion_ratio.back() = 0.01;
  const base::Result<Frame> result = FrameBuilder(options).build(raw);
  ASSERT_TRUE(result.ok()) << result.status.message;
  EXPECT_TRUE(result.value.noise_model == options.noise_model);
  const cv::Mat& depth_m = result.value.depth_m;
  EXPECT_TRUE(std::isnan(depth_m.at<float>(0, 0)));
  EXPECT_NEAR(depth_m.at<float>(0, 5), 2 - 0.001 + 0.004 - 0.012, 1e-6);
  EXPECT_NEAR(depth_m.at<float>(depth_m.rows - 1, depth_m.cols - 1), 2 - 0.001 + 0.004 - 0.012 - 0.02, 1e-6);
  EXPECT_EQ(raw.depth.at<std::uint16_t>(5, 5), 2000);
}

TEST(FrameBuilder, ShiftsColorOntoDepth)
{
  for (const std::vector<double>& distortion :
       std::vector<std::vector<double>>{ {}, { 0, 0, 0, 0, 0 }, { 1e-6, 0, 0, 0, 0 } })
  {
    RawFrame raw = goodFrame();
    raw.camera.distortion = distortion;
    raw.color = cv::Mat(480, 640, CV_8UC1);
    for (int v = 0; v < 480; ++v)
      for (int u = 0; u < 640; ++u)
        raw.color.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(20 + 0.2 * u + 0.1 * v);
    raw.depth.at<std::uint16_t>(200, 300) = 1600;
    FrameBuilderOptions options;
    options.noise_model.color_offset_x_px = 15;
    options.noise_model.color_offset_y_px = -2.5;
    const base::Result<Frame> result = FrameBuilder(options).build(raw);
    ASSERT_TRUE(result.ok()) << result.status.message;
    EXPECT_NEAR(result.value.gray.at<std::uint8_t>(200, 300), 20 + 0.2 * 315 + 0.1 * 197.5, 1);
    EXPECT_FLOAT_EQ(result.value.depthAt_m(300, 200), 1.6f);
  }
}

TEST(FrameBuilder, WithoutBiasDepthStaysAsItIs)
{
  const base::Result<Frame> plain = FrameBuilder().build(goodFrame());
  FrameBuilderOptions options;
  options.noise_model.axial_constant_m = 0.01;
  const base::Result<Frame> noisy = FrameBuilder(options).build(goodFrame());
  EXPECT_EQ(cv::norm(plain.value.depth_m, noisy.value.depth_m, cv::NORM_INF), 0);
  options.noise_model.axial_constant_m = -1;
  EXPECT_THROW(FrameBuilder{ options }, base::Error);
}

TEST(FrameBuilder, MaskBecomesBlackAndWhite)
{
  RawFrame raw = goodFrame();
  raw.object_mask = cv::Mat::zeros(480, 640, CV_8UC1);
  raw.object_mask.at<std::uint8_t>(4, 5) = 1;
  const base::Result<Frame> result = FrameBuilder().build(raw);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.value.object_mask.at<std::uint8_t>(4, 5), 255);
  EXPECT_EQ(cv::countNonZero(result.value.object_mask), 1);
}

TEST(FrameBuilder, RefusesUnusableInput)
{
  RawFrame raw = goodFrame();
  raw.color.release();
  expectRefused(raw, "colour image is empty");
  raw = goodFrame();
  raw.depth.release();
  expectRefused(raw, "depth image is empty");
  raw = goodFrame();
  raw.color = cv::Mat(480, 640, CV_16UC3, cv::Scalar::all(1));
  expectRefused(raw, "CV_16UC3");
  raw = goodFrame();
  raw.depth = cv::Mat(480, 640, CV_8UC1, cv::Scalar(1));
  expectRefused(raw, "CV_8UC1");
  raw = goodFrame();
  raw.depth = cv::Mat(240, 320, CV_16UC1, cv::Scalar(1500));
  expectRefused(raw, "320x240, colour image 640x480");
  raw = goodFrame();
  raw.camera = raw.camera.scaled(0.5);
  expectRefused(raw, "camera info 320x240");
  raw = goodFrame();
  raw.camera = geometry::PinholeCamera();
  expectRefused(raw, "camera/width");
  raw = goodFrame();
  raw.camera.fx = std::numeric_limits<double>::quiet_NaN();
  expectRefused(raw, "camera/fx");
  raw = goodFrame();
  raw.depth_unit_m = 0;
  expectRefused(raw, "depth unit");
  raw = goodFrame();
  raw.object_mask = cv::Mat::zeros(10, 10, CV_8UC1);
  expectRefused(raw, "object mask is 10x10");
}

TEST(FrameBuilder, RefusesUnsynchronisedStamps)
{
  RawFrame raw = goodFrame();
  raw.depth_stamp_s = raw.stamp_s - 0.02;
  EXPECT_TRUE(FrameBuilder().build(raw).ok());
  raw.depth_stamp_s = raw.stamp_s + 0.05;
  expectRefused(raw, "0.050000 s apart");
  raw.depth_stamp_s = std::numeric_limits<double>::quiet_NaN();
  expectRefused(raw, "apart");
}

TEST(FrameBuilder, RefusesCoveredCamera)
{
  RawFrame raw = goodFrame();
  raw.depth = 0;
  expectRefused(raw, "only 0 of 307200 pixels have depth");
  raw.depth = 50;  // 5 cm: nearer than min_depth_m
  expectRefused(raw, "covered");
  raw.depth.rowRange(0, 1) = 1500;
  EXPECT_TRUE(FrameBuilder().build(raw).ok());  // 640 of 307200 are more than 0.1 %
}

TEST(FrameBuilder, RefusesBadOptions)
{
  FrameBuilderOptions options;
  options.max_depth_m = options.min_depth_m;
  options.min_depth_ratio = 2;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "max_depth_m", "min_depth_ratio" }));
  EXPECT_THROW(FrameBuilder{ options }, base::Error);
}

RawFrame distortedFrame()
{
  RawFrame raw = goodFrame();
  raw.camera.fx = 517.3;
  raw.camera.fy = 516.5;
  raw.camera.cx = 318.6;
  raw.camera.cy = 255.3;
  raw.camera.distortion = { 0.2624, -0.9531, -0.0054, 0.0026, 1.1633 };
  return raw;
}

/// Where a pixel of the distorted image belongs in the rectified one.
cv::Point2d rectified(const geometry::PinholeCamera& camera, const cv::Point2d& pixel)
{
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  std::vector<cv::Point2d> out;
  cv::undistortPoints(std::vector<cv::Point2d>{ pixel }, out, K, camera.distortion, cv::noArray(), K);
  return out.front();
}

TEST(FrameBuilder, RectifiesColorToWhereUndistortPointsSays)
{
  for (const cv::Point spot : { cv::Point(320, 240), cv::Point(120, 90), cv::Point(560, 400), cv::Point(60, 420) })
  {
    RawFrame raw = distortedFrame();
    raw.color = cv::Scalar::all(0);
    raw.color(cv::Rect(spot.x - 3, spot.y - 3, 7, 7)) = cv::Scalar::all(255);
    const base::Result<Frame> result = FrameBuilder().build(raw);
    ASSERT_TRUE(result.ok()) << result.status.message;
    const cv::Moments moments = cv::moments(result.value.gray);
    const cv::Point2d expected = rectified(raw.camera, spot);
    EXPECT_NEAR(moments.m10 / moments.m00, expected.x, 0.1);
    EXPECT_NEAR(moments.m01 / moments.m00, expected.y, 0.1);
  }
}

TEST(FrameBuilder, RectifiesDepthAndMaskToTheNearestPixelUnbiased)
{
  cv::Point2d sum(0, 0);
  const std::vector<cv::Point> spots = { { 320, 240 }, { 120, 90 }, { 560, 400 }, { 60, 420 }, { 500, 60 } };
  for (const cv::Point& spot : spots)
  {
    RawFrame raw = distortedFrame();
    const cv::Rect patch(spot.x - 6, spot.y - 6, 13, 13);
    raw.depth(patch) = 3000;
    raw.object_mask = cv::Mat::zeros(480, 640, CV_8UC1);
    raw.object_mask(patch) = 1;
    const base::Result<Frame> result = FrameBuilder().build(raw);
    ASSERT_TRUE(result.ok());
    const cv::Mat far = result.value.depth_m > 2.5f;
    EXPECT_EQ(cv::norm(far, result.value.object_mask, cv::NORM_INF), 0);
    const cv::Moments moments = cv::moments(far, true);
    const cv::Point2d off =
        cv::Point2d(moments.m10 / moments.m00, moments.m01 / moments.m00) - rectified(raw.camera, spot);
    EXPECT_LT(cv::norm(off), 0.5);
    sum += off;
  }
  EXPECT_LT(cv::norm(sum) / static_cast<double>(spots.size()), 0.25);
}

TEST(FrameBuilder, OutsideOfTheDistortedImageDepthIsMissing)
{
  RawFrame raw = distortedFrame();
  raw.camera.distortion = { 0.5, 0, 0, 0, 0 };  // pincushion: the corners would come from outside
  const base::Result<Frame> result = FrameBuilder().build(raw);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(std::isnan(result.value.depthAt_m(0, 0)));
  EXPECT_FLOAT_EQ(result.value.depthAt_m(320, 240), 1.5f);
}

TEST(FrameBuilder, AnotherCameraGetsMapsOfItsOwn)
{
  FrameBuilder builder;
  RawFrame raw = distortedFrame();
  raw.color(cv::Rect(100, 80, 40, 30)) = cv::Scalar::all(255);
  const cv::Mat first = builder.build(raw).value.gray.clone();
  RawFrame other = raw;
  other.camera.distortion[0] = -0.2;
  const cv::Mat second = builder.build(other).value.gray.clone();
  EXPECT_GT(cv::norm(first, second, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(first, builder.build(raw).value.gray, cv::NORM_INF), 0);
}

TEST(FrameBuilder, RationalModelWithEightCoefficients)
{
  RawFrame raw = distortedFrame();
  raw.camera.distortion = { 0.3, -0.1, 0.001, -0.001, 0.02, 0.4, -0.05, 0.01 };
  raw.color = cv::Scalar::all(0);
  raw.color(cv::Rect(97, 67, 7, 7)) = cv::Scalar::all(255);
  const base::Result<Frame> result = FrameBuilder().build(raw);
  ASSERT_TRUE(result.ok());
  const cv::Moments moments = cv::moments(result.value.gray);
  const cv::Point2d expected = rectified(raw.camera, { 100, 70 });
  EXPECT_NEAR(moments.m10 / moments.m00, expected.x, 0.1);
  EXPECT_NEAR(moments.m01 / moments.m00, expected.y, 0.1);
}

}  // namespace
}  // namespace object_modelling::rgbd
