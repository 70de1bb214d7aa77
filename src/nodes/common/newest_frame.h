#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "frame_pairer.h"
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
  template <typename Message>
  void subscribe(ros::NodeHandle& node, const char* topic,
                 std::optional<FrameMessages> (FramePairer::*add)(const boost::shared_ptr<const Message>&));
  std::string reasonForNone() const;

  rgbd::FrameBuilder builder_;
  FramePairer pairer_;
  std::map<std::string, bool> heard_;  ///< by topic: whether any message has come
  std::optional<FrameMessages> newest_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace object_modelling::nodes
