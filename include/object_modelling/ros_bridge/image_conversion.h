#pragma once

#include <string>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

namespace object_modelling::ros_bridge
{
/// Copies of a message's pixels. Every function throws base::Error (BAD_INPUT) that names the encoding, size or length
/// that cannot be used. Any row step and byte order is read.

/// CV_8UC3 BGR, or CV_8UC1 for mono images: RGB8, BGR8, RGBA8, BGRA8, MONO8, MONO16, Bayer 8 bit, YUV 4:2:2.
cv::Mat colorFromMessage(const sensor_msgs::Image& message);
/// CV_16UC1 (16UC1, mono16; millimetres by REP 118) or CV_32FC1 (32FC1; metres).
cv::Mat depthFromMessage(const sensor_msgs::Image& message);
/// CV_8UC1 of a mono8 or 8UC1 image; an image of width 0 gives an empty mask.
cv::Mat maskFromMessage(const sensor_msgs::Image& message);

/// CV_8UC3 as bgr8, CV_8UC1 as mono8, CV_16UC1 as 16UC1, CV_32FC1 as 32FC1; an empty image as one of width 0. Throws
/// base::Error (INTERNAL) for any other type.
sensor_msgs::Image toMessage(const cv::Mat& image, const std_msgs::Header& header);

/// Whether an encoding is one of a depth image.
bool isDepthEncoding(const std::string& encoding);

}  // namespace object_modelling::ros_bridge
