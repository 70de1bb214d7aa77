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
    : builder_(options), pairer_(options.max_stamp_difference_s, false)
{
  subscribe<sensor_msgs::Image>(node, names::COLOR, &FramePairer::addColor);
  subscribe<sensor_msgs::Image>(node, names::DEPTH, &FramePairer::addDepth);
  subscribe<sensor_msgs::CameraInfo>(node, names::CAMERA_INFO, &FramePairer::addInfo);
}

template <typename Message>
void NewestFrame::subscribe(ros::NodeHandle& node, const char* topic,
                            std::optional<FrameMessages> (FramePairer::*add)(const boost::shared_ptr<const Message>&))
{
  const std::string resolved = node.resolveName(topic);
  heard_[resolved] = false;
  const boost::function<void(const boost::shared_ptr<const Message>&)> take =
      [this, resolved, add](const boost::shared_ptr<const Message>& message)
  {
    heard_[resolved] = true;
    if (std::optional<FrameMessages> frame = (pairer_.*add)(message))
      newest_ = std::move(frame);
  };
  subscribers_.push_back(node.subscribe<Message>(topic, QUEUE_SIZE, take));
}

ros::Time NewestFrame::stamp() const
{
  return newest_ ? newest_->color->header.stamp : ros::Time();
}

base::Result<StampedFrame> NewestFrame::get()
{
  base::Result<StampedFrame> result;
  if (!newest_)
  {
    result.status = { base::StatusCode::FAILED_PRECONDITION, "no frame yet: " + reasonForNone() };
    return result;
  }
  result.value.header = newest_->color->header;
  result.status = ros_bridge::guarded(
      [&]
      {
        base::Result<rgbd::Frame> frame = builder_.build(ros_bridge::rawFrameFromMessages(
            *newest_->color, *newest_->depth, *newest_->info, ros_bridge::ImageKind::RECTIFIED));
        if (!frame.ok())
          throw base::Error(frame.status.code, frame.status.message);
        result.value.frame = std::move(frame.value);
      });
  return result;
}

std::string NewestFrame::reasonForNone() const
{
  std::string silent;
  for (const auto& [topic, heard] : heard_)
    if (!heard)
      silent += (silent.empty() ? "" : ", ") + topic;
  if (!silent.empty())
    return "no message on " + silent + "; is the camera running and remapped?";
  return "colour and depth come, but with stamps too far apart (nearest: " +
         std::to_string(pairer_.unpairedDifference_s()) + " s; allowed: frame/max_stamp_difference_s)";
}

}  // namespace object_modelling::nodes
