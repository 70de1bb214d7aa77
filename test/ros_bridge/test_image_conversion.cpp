#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/image_conversion.h"

namespace object_modelling::ros_bridge
{
namespace
{
namespace encodings = sensor_msgs::image_encodings;

sensor_msgs::Image image(const std::string& encoding, unsigned width, unsigned height, unsigned step,
                         const std::vector<std::uint8_t>& data)
{
  sensor_msgs::Image message;
  message.encoding = encoding;
  message.width = width;
  message.height = height;
  message.step = step;
  message.data = data;
  return message;
}

std::string refusal(const std::function<void()>& body)
{
  try
  {
    body();
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(base::StatusCode::BAD_INPUT, error.code());
    return error.what();
  }
  return "nothing was refused";
}

TEST(ImageConversion, ColorOrderOfEveryEncoding)
{
  const cv::Vec3b red(0, 0, 255);
  EXPECT_EQ(red, colorFromMessage(image("rgb8", 1, 1, 3, { 255, 0, 0 })).at<cv::Vec3b>(0, 0));
  EXPECT_EQ(red, colorFromMessage(image("bgr8", 1, 1, 3, { 0, 0, 255 })).at<cv::Vec3b>(0, 0));
  EXPECT_EQ(red, colorFromMessage(image("rgba8", 1, 1, 4, { 255, 0, 0, 9 })).at<cv::Vec3b>(0, 0));
  EXPECT_EQ(red, colorFromMessage(image("bgra8", 1, 1, 4, { 0, 0, 255, 9 })).at<cv::Vec3b>(0, 0));
  EXPECT_EQ(CV_8UC1, colorFromMessage(image("mono8", 2, 1, 2, { 7, 8 })).type());
  EXPECT_EQ(CV_8UC1, colorFromMessage(image("8UC1", 2, 1, 2, { 7, 8 })).type());
}

TEST(ImageConversion, BayerBecomesColor)
{
  // A red scene: only the red sites of an RGGB pattern are bright.
  std::vector<std::uint8_t> data(8 * 8, 0);
  for (int v = 0; v < 8; v += 2)
    for (int u = 0; u < 8; u += 2)
      data[v * 8 + u] = 200;
  const cv::Vec3b pixel = colorFromMessage(image("bayer_rggb8", 8, 8, 8, data)).at<cv::Vec3b>(4, 4);
  EXPECT_EQ(200, pixel[2]);
  EXPECT_EQ(0, pixel[0]);
}

TEST(ImageConversion, RowsMayBePadded)
{
  const cv::Mat color = colorFromMessage(image("bgr8", 1, 2, 5, { 1, 2, 3, 99, 99, 4, 5, 6, 99, 99 }));
  EXPECT_EQ(cv::Vec3b(4, 5, 6), color.at<cv::Vec3b>(1, 0));
  // A step that is no multiple of the element, and no padding after the last row.
  const cv::Mat depth = depthFromMessage(image("16UC1", 1, 2, 3, { 1, 1, 99, 2, 2 }));
  EXPECT_EQ(0x0101, depth.at<std::uint16_t>(0, 0));
  EXPECT_EQ(0x0202, depth.at<std::uint16_t>(1, 0));
}

TEST(ImageConversion, ByteOrderIsRespected)
{
  sensor_msgs::Image message = image("16UC1", 1, 1, 2, { 0x03, 0xe8 });
  message.is_bigendian = true;
  EXPECT_EQ(1000, depthFromMessage(message).at<std::uint16_t>(0, 0));
}

TEST(ImageConversion, DepthInMeters)
{
  const float value = 1.25f;
  std::vector<std::uint8_t> data(4);
  std::memcpy(data.data(), &value, 4);
  const cv::Mat depth = depthFromMessage(image("32FC1", 1, 1, 4, data));
  ASSERT_EQ(CV_32FC1, depth.type());
  EXPECT_EQ(value, depth.at<float>(0, 0));
}

TEST(ImageConversion, ResultOwnsItsPixels)
{
  sensor_msgs::Image message = image("bgr8", 1, 1, 3, { 1, 2, 3 });
  const cv::Mat color = colorFromMessage(message);
  message.data.assign(3, 77);
  EXPECT_EQ(cv::Vec3b(1, 2, 3), color.at<cv::Vec3b>(0, 0));
}

TEST(ImageConversion, RefusalsNameTheEncodingAndSize)
{
  const auto names = [](const std::string& text, const std::string& what)
  { return text.find(what) != std::string::npos; };
  EXPECT_TRUE(names(refusal([] { colorFromMessage(image("h264", 1, 1, 1, { 1 })); }), "\"h264\""));
  EXPECT_TRUE(names(refusal([] { colorFromMessage(image("16UC1", 1, 1, 2, { 1, 1 })); }), "\"16UC1\""));
  EXPECT_TRUE(names(refusal([] { depthFromMessage(image("rgb8", 1, 1, 3, { 1, 1, 1 })); }), "\"rgb8\""));
  EXPECT_TRUE(names(refusal([] { depthFromMessage(image("64FC1", 1, 1, 8, {})); }), "\"64FC1\""));
  EXPECT_TRUE(names(refusal([] { maskFromMessage(image("rgb8", 1, 1, 3, { 1, 1, 1 })); }), "\"rgb8\""));
  EXPECT_TRUE(names(refusal([] { colorFromMessage(image("rgb8", 4, 4, 12, { 1, 2 })); }), "4 x 4"));
  EXPECT_TRUE(names(refusal([] { colorFromMessage(image("rgb8", 4, 1, 3, { 1, 2, 3 })); }), "cut short"));
  EXPECT_TRUE(names(refusal([] { colorFromMessage(image("rgb8", 0, 0, 0, {})); }), "no pixels"));
}

TEST(ImageConversion, RoundTrip)
{
  cv::Mat depth(3, 5, CV_32FC1, cv::Scalar(0.5));
  depth.at<float>(1, 2) = NAN;
  const cv::Mat back = depthFromMessage(toMessage(depth, std_msgs::Header()));
  ASSERT_EQ(depth.size(), back.size());
  EXPECT_EQ(0, std::memcmp(depth.data, back.data, depth.total() * depth.elemSize()));

  const cv::Mat color(3, 5, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat wide(3, 9, CV_8UC3, cv::Scalar(4, 5, 6));
  EXPECT_EQ(0, cv::norm(color, colorFromMessage(toMessage(color, std_msgs::Header())), cv::NORM_INF));
  const cv::Mat part = wide(cv::Rect(2, 0, 5, 3));  // not continuous
  EXPECT_EQ(0, cv::norm(part, colorFromMessage(toMessage(part, std_msgs::Header())), cv::NORM_INF));
}

TEST(ImageConversion, EmptyMaskStaysEmpty)
{
  const sensor_msgs::Image message = toMessage(cv::Mat(), std_msgs::Header());
  EXPECT_EQ(0u, message.width);
  EXPECT_TRUE(maskFromMessage(message).empty());
}
}  // namespace
}  // namespace object_modelling::ros_bridge
