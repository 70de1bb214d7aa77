#include "object_modelling/ros_bridge/frame_publisher.h"

#include <cstdint>
#include <map>
#include <string>

#include <ros/master.h>
#include <ros/this_node.h>

#include "object_modelling/ros_bridge/camera_conversion.h"
#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/names.h"

namespace object_modelling::ros_bridge
{
namespace
{
constexpr int QUEUE_SIZE = 10;

/// How many nodes have registered with the master as subscribers of each topic.
std::map<std::string, std::uint32_t> registeredSubscribers()
{
  std::map<std::string, std::uint32_t> counts;
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, payload, false))
    return counts;
  XmlRpc::XmlRpcValue& subscribers = payload[1];
  for (int i = 0; i < subscribers.size(); ++i)
    counts[static_cast<std::string>(subscribers[i][0])] = static_cast<std::uint32_t>(subscribers[i][1].size());
  return counts;
}
}  // namespace

FramePublisher::FramePublisher(ros::NodeHandle& node, const std::string& frame_id)
    : frame_id_(frame_id),
      color_(node.advertise<sensor_msgs::Image>(names::COLOR, QUEUE_SIZE)),
      depth_(node.advertise<sensor_msgs::Image>(names::DEPTH, QUEUE_SIZE)),
      info_(node.advertise<sensor_msgs::CameraInfo>(names::CAMERA_INFO, QUEUE_SIZE)),
      mask_(node.advertise<sensor_msgs::Image>(names::OBJECT_MASK, QUEUE_SIZE))
{
}

void FramePublisher::publish(const rgbd::Frame& frame, const ros::Time& color_stamp, const ros::Time& depth_stamp,
                             const geometry::PinholeCamera& raw_camera)
{
  std_msgs::Header header;
  header.frame_id = frame_id_;
  header.stamp = color_stamp;
  info_.publish(toMessage(raw_camera, frame.camera, header));
  if (!frame.object_mask.empty())
    mask_.publish(toMessage(frame.object_mask, header));
  color_.publish(toMessage(frame.color_bgr, header));
  header.stamp = depth_stamp;
  depth_.publish(toMessage(frame.depth_m, header));
}

bool FramePublisher::allConnected() const
{
  const std::map<std::string, std::uint32_t> registered = registeredSubscribers();
  for (const ros::Publisher* publisher : { &color_, &depth_, &info_, &mask_ })
  {
    const auto found = registered.find(publisher->getTopic());
    if (found != registered.end() && publisher->getNumSubscribers() < found->second)
      return false;
  }
  return true;
}

}  // namespace object_modelling::ros_bridge
