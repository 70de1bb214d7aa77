#pragma once

#include <string>

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>

#include "object_modelling/ros_bridge/camera_conversion.h"
#include "object_modelling/ros_bridge/image_conversion.h"

namespace object_modelling::ros_bridge::test
{
/// Writes small recordings; the grey level of a colour image and the millimetres of a depth image are its index.
class BagWriter
{
public:
  explicit BagWriter(const std::string& path) : bag_(path, rosbag::bagmode::Write) {}

  static std_msgs::Header header(double stamp_s, const std::string& frame_id = "cam")
  {
    std_msgs::Header header;
    header.stamp = ros::Time(stamp_s);
    header.frame_id = frame_id;
    return header;
  }
  void color(const std::string& topic, double stamp_s, int value)
  {
    bag_.write(topic, ros::Time(stamp_s), toMessage(cv::Mat(6, 8, CV_8UC3, cv::Scalar::all(value)), header(stamp_s)));
  }
  void depth(const std::string& topic, double stamp_s, int value, double received_s = 0,
             const std::string& frame_id = "cam")
  {
    bag_.write(topic, ros::Time(received_s > 0 ? received_s : stamp_s),
               toMessage(cv::Mat(6, 8, CV_16UC1, cv::Scalar(value)), header(stamp_s, frame_id)));
  }
  void mask(const std::string& topic, double stamp_s)
  {
    bag_.write(topic, ros::Time(stamp_s), toMessage(cv::Mat(6, 8, CV_8UC1, cv::Scalar(255)), header(stamp_s)));
  }
  void info(const std::string& topic, double stamp_s)
  {
    geometry::PinholeCamera raw;
    raw.width = 8;
    raw.height = 6;
    raw.fx = raw.fy = 10;
    raw.cx = 3.5;
    raw.cy = 2.5;
    geometry::PinholeCamera rectified = raw;
    rectified.fx = 9;
    raw.distortion = { 0.1, 0, 0, 0, 0 };
    bag_.write(topic, ros::Time(stamp_s), toMessage(raw, rectified, header(stamp_s)));
  }
  void close() { bag_.close(); }

private:
  rosbag::Bag bag_;
};

}  // namespace object_modelling::ros_bridge::test
