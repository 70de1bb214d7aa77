#include "newest_frame.h"

#include "object_modelling/ros_bridge/frame_conversion.h"
#include "object_modelling/ros_bridge/names.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace names = ros_bridge::names;

namespace
{
constexpr int QUEUE_SIZE = 5;
}

NewestFrame::NewestFrame(ros::NodeHandle& node, const rgbd::FrameBuilderOptions& options)
  : builder_(options)
  , color_subscriber_(node, names::COLOR, QUEUE_SIZE)
  , depth_subscriber_(node, names::DEPTH, QUEUE_SIZE)
  , info_subscriber_(node, names::CAMERA_INFO, QUEUE_SIZE)
  , synchronizer_(Policy(2 * QUEUE_SIZE), color_subscriber_, depth_subscriber_, info_subscriber_)
{
  for (const char* name : { names::COLOR, names::DEPTH, names::CAMERA_INFO })
    heard_[node.resolveName(name)] = false;
  color_subscriber_.registerCallback(
      [this](const sensor_msgs::ImageConstPtr&) { heard_[color_subscriber_.getSubscriber().getTopic()] = true; });
  depth_subscriber_.registerCallback(
      [this](const sensor_msgs::ImageConstPtr&) { heard_[depth_subscriber_.getSubscriber().getTopic()] = true; });
  info_subscriber_.registerCallback(
      [this](const sensor_msgs::CameraInfoConstPtr&) { heard_[info_subscriber_.getSubscriber().getTopic()] = true; });
  synchronizer_.registerCallback(&NewestFrame::take, this);
}

void NewestFrame::take(const sensor_msgs::ImageConstPtr& color, const sensor_msgs::ImageConstPtr& depth,
                       const sensor_msgs::CameraInfoConstPtr& info)
{
  color_ = color;
  depth_ = depth;
  info_ = info;
}

ros::Time NewestFrame::stamp() const
{
  return color_ ? color_->header.stamp : ros::Time();
}

base::Result<StampedFrame> NewestFrame::get()
{
  base::Result<StampedFrame> result;
  if (!color_)
  {
    const std::string silent = silentTopics();
    result.status = { base::StatusCode::FAILED_PRECONDITION,
                      silent.empty() ? "no frame yet: colour, depth and camera info come, but with stamps too far apart"
                                     : "no frame yet: no message on " + silent + "; is the camera running and remapped?" };
    return result;
  }
  result.value.header = color_->header;
  result.status = ros_bridge::guarded([&] {
    base::Result<rgbd::Frame> frame = builder_.build(
        ros_bridge::rawFrameFromMessages(*color_, *depth_, *info_, ros_bridge::ImageKind::RECTIFIED));
    if (!frame.ok())
      throw base::Error(frame.status.code, frame.status.message);
    result.value.frame = std::move(frame.value);
  });
  return result;
}

std::string NewestFrame::silentTopics() const
{
  std::string silent;
  for (const auto& [topic, heard] : heard_)
    if (!heard)
      silent += (silent.empty() ? "" : ", ") + topic;
  return silent;
}

}  // namespace object_modelling::nodes
