#include "object_modelling/ros_bridge/frame_publisher.h"

#include "object_modelling/ros_bridge/camera_conversion.h"
#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/names.h"

namespace object_modelling::ros_bridge
{
namespace
{
constexpr int QUEUE_SIZE = 10;
}

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

}  // namespace object_modelling::ros_bridge
