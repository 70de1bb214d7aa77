#pragma once

#include <map>
#include <string>

#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "object_modelling/rgbd/frame_builder.h"

namespace object_modelling::nodes
{
struct StampedFrame
{
  std_msgs::Header header;  ///< of the colour image
  rgbd::Frame frame;
};

/// Keeps the messages of the newest frame and makes a frame of them when asked. Not thread safe.
class NewestFrame
{
public:
  NewestFrame(ros::NodeHandle& node, const rgbd::FrameBuilderOptions& options);

  /// FAILED_PRECONDITION names the topics that are silent; BAD_INPUT what is wrong with the frame.
  base::Result<StampedFrame> get();
  /// Stamp of the newest frame; 0 before the first.
  ros::Time stamp() const;

private:
  using Policy = message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::Image,
                                                                 sensor_msgs::CameraInfo>;

  void take(const sensor_msgs::ImageConstPtr& color, const sensor_msgs::ImageConstPtr& depth,
            const sensor_msgs::CameraInfoConstPtr& info);
  std::string silentTopics() const;

  rgbd::FrameBuilder builder_;
  message_filters::Subscriber<sensor_msgs::Image> color_subscriber_, depth_subscriber_;
  message_filters::Subscriber<sensor_msgs::CameraInfo> info_subscriber_;
  message_filters::Synchronizer<Policy> synchronizer_;
  std::map<std::string, bool> heard_;  ///< by topic: whether any message has come
  sensor_msgs::ImageConstPtr color_, depth_;
  sensor_msgs::CameraInfoConstPtr info_;
};

}  // namespace object_modelling::nodes
