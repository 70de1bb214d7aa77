#include "object_modelling/ros_bridge/frame_conversion.h"

#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/time_conversion.h"

namespace object_modelling::ros_bridge
{
rgbd::RawFrame rawFrameFromMessages(const sensor_msgs::Image& color, const sensor_msgs::Image& depth,
                                    const sensor_msgs::CameraInfo& info, ImageKind kind)
{
  rgbd::RawFrame raw;
  raw.stamp_s = toSeconds(color.header.stamp);
  raw.depth_stamp_s = toSeconds(depth.header.stamp);
  raw.color = colorFromMessage(color);
  raw.depth = depthFromMessage(depth);
  raw.camera = fromMessage(info, kind);
  return raw;
}

base::Status checkRegistered(const std_msgs::Header& color, const std_msgs::Header& depth)
{
  if (color.frame_id == depth.frame_id)
    return {};
  return { base::StatusCode::BAD_INPUT, "depth is given in frame \"" + depth.frame_id + "\" and colour in \"" +
                                            color.frame_id +
                                            "\": it is not registered to colour; switch registration on in the driver "
                                            "or run depth_image_proc/register" };
}

}  // namespace object_modelling::ros_bridge
