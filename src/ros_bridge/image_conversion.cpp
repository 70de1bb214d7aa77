#include "object_modelling/ros_bridge/image_conversion.h"

#include <cstring>

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include "object_modelling/base/status.h"

namespace object_modelling::ros_bridge
{
namespace
{
namespace encodings = sensor_msgs::image_encodings;

[[noreturn]] void refuse(const sensor_msgs::Image& message, const std::string& reason)
{
  throw base::Error(base::StatusCode::BAD_INPUT, "image of " + std::to_string(message.width) + " x " +
                                                     std::to_string(message.height) + " with encoding \"" +
                                                     message.encoding + "\" " + reason);
}

int bytesPerPixel(const sensor_msgs::Image& message)
{
  try
  {
    return encodings::numChannels(message.encoding) * encodings::bitDepth(message.encoding) / 8;
  }
  catch (const std::runtime_error&)
  {
    refuse(message, "cannot be read: the encoding is not known");
  }
}

void checkLayout(const sensor_msgs::Image& message)
{
  if (message.width == 0 || message.height == 0)
    refuse(message, "has no pixels");
  const std::size_t row_bytes = static_cast<std::size_t>(message.width) * bytesPerPixel(message);
  const std::size_t needed = static_cast<std::size_t>(message.step) * (message.height - 1) + row_bytes;
  if (message.step < row_bytes || message.data.size() < needed)
    refuse(message, "is cut short: row step " + std::to_string(message.step) + ", " +
                        std::to_string(message.data.size()) + " bytes");
}

/// The same image without padding between rows: cv_bridge needs whole steps, cv::Mat steps of whole elements.
sensor_msgs::Image compact(const sensor_msgs::Image& message)
{
  sensor_msgs::Image result;
  result.header = message.header;
  result.encoding = message.encoding;
  result.is_bigendian = message.is_bigendian;
  result.width = message.width;
  result.height = message.height;
  result.step = message.width * bytesPerPixel(message);
  result.data.resize(static_cast<std::size_t>(result.step) * result.height);
  for (std::size_t row = 0; row < result.height; ++row)
    std::memcpy(&result.data[row * result.step], &message.data[row * message.step], result.step);
  return result;
}

/// Deep copy, converted to `encoding`; unconverted if that is empty.
cv::Mat converted(const sensor_msgs::Image& message, const std::string& encoding)
{
  checkLayout(message);
  const bool whole_rows = message.step == message.width * static_cast<unsigned>(bytesPerPixel(message)) &&
                          message.data.size() == static_cast<std::size_t>(message.step) * message.height;
  try
  {
    return cv_bridge::toCvCopy(whole_rows ? message : compact(message), encoding)->image;
  }
  catch (const std::exception& error)
  {
    refuse(message, std::string("cannot be read: ") + error.what());
  }
}
}  // namespace

bool isDepthEncoding(const std::string& encoding)
{
  return encoding == encodings::TYPE_16UC1 || encoding == encodings::TYPE_32FC1 || encoding == encodings::MONO16;
}

cv::Mat colorFromMessage(const sensor_msgs::Image& message)
{
  const std::string& encoding = message.encoding;
  if (encoding == encodings::TYPE_8UC1)
    return converted(message, "");
  if (encodings::isMono(encoding))
    return converted(message, encodings::MONO8);
  if (encodings::isColor(encoding) || encodings::isBayer(encoding) || encoding == encodings::YUV422)
    return converted(message, encodings::BGR8);
  refuse(message, "is no colour image; supported are rgb8, bgr8, rgba8, bgra8, mono8, mono16, bayer_*8, yuv422");
}

cv::Mat depthFromMessage(const sensor_msgs::Image& message)
{
  if (!isDepthEncoding(message.encoding))
    refuse(message, "is no depth image; supported are 16UC1 (millimetres) and 32FC1 (metres)");
  return converted(message, "");
}

cv::Mat maskFromMessage(const sensor_msgs::Image& message)
{
  if (message.width == 0)
    return {};
  if (message.encoding != encodings::MONO8 && message.encoding != encodings::TYPE_8UC1)
    refuse(message, "is no object mask; supported is mono8");
  return converted(message, "");
}

sensor_msgs::Image toMessage(const cv::Mat& image, const std_msgs::Header& header)
{
  sensor_msgs::Image message;
  message.header = header;
  switch (image.empty() ? CV_8UC1 : image.type())
  {
    case CV_8UC3:
      message.encoding = encodings::BGR8;
      break;
    case CV_8UC1:
      message.encoding = encodings::MONO8;
      break;
    case CV_16UC1:
      message.encoding = encodings::TYPE_16UC1;
      break;
    case CV_32FC1:
      message.encoding = encodings::TYPE_32FC1;
      break;
    default:
      throw base::Error(base::StatusCode::INTERNAL, "no image message for OpenCV type " + std::to_string(image.type()));
  }
  if (!image.empty())
    cv_bridge::CvImage(header, message.encoding, image).toImageMsg(message);
  return message;
}

}  // namespace object_modelling::ros_bridge
