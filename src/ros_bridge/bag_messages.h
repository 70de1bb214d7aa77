#pragma once

#include <deque>
#include <memory>
#include <string>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "object_modelling/ros_bridge/bag_source.h"

namespace object_modelling::ros_bridge
{
/// Messages of one instant. `object_mask` may be null.
struct BagInstant
{
  sensor_msgs::Image::ConstPtr color, depth, object_mask;
  sensor_msgs::CameraInfo::ConstPtr info;
};

/// Walks through a bag once and pairs each colour image with the depth image nearest in stamp, whatever the order in
/// which they were recorded.
class BagMessages
{
public:
  BagMessages(rosbag::Bag& bag, const BagTopics& topics, double max_stamp_difference_s);

  /// False at the end. Throws rosbag::BagException for a damaged file.
  bool next(BagInstant* instant);
  std::size_t colorCount() const { return color_count_; }

private:
  void readOne();
  bool decided() const;
  /// Takes the depth nearest to the first colour image; null if none is near enough.
  sensor_msgs::Image::ConstPtr takeDepth(const ros::Time& stamp);
  sensor_msgs::Image::ConstPtr takeMask(const ros::Time& stamp);

  BagTopics topics_;
  ros::Duration max_difference_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator position_;
  std::size_t color_count_ = 0;
  std::deque<sensor_msgs::Image::ConstPtr> colors_, depths_, masks_;
  sensor_msgs::CameraInfo::ConstPtr info_;
};

}  // namespace object_modelling::ros_bridge
