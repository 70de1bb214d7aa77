#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/ros_bridge/camera_conversion.h"

namespace object_modelling::ros_bridge
{
/// Images and intrinsics of one instant, still unchecked: rgbd::FrameBuilder does that. Throws base::Error (BAD_INPUT)
/// as the conversions of its parts do. The raw frame owns its pixels.
rgbd::RawFrame rawFrameFromMessages(const sensor_msgs::Image& color, const sensor_msgs::Image& depth,
                                    const sensor_msgs::CameraInfo& info, ImageKind kind);

/// BAD_INPUT if depth is not given in the colour camera's frame, which means that it is not registered to it.
base::Status checkRegistered(const std_msgs::Header& color, const std_msgs::Header& depth);

}  // namespace object_modelling::ros_bridge
