#pragma once

#include <string>

#include <rosbag/bag.h>

#include "object_modelling/ros_bridge/bag_source.h"

namespace object_modelling::ros_bridge
{
/// Completes `wanted` by what the bag holds. Throws base::Error naming `path`: NOT_FOUND for a named topic that is not
/// there or has another type, BAD_INPUT where none or several fit, listing the image topics with their encodings.
BagTopics findTopics(rosbag::Bag& bag, const std::string& path, const BagTopics& wanted);

}  // namespace object_modelling::ros_bridge
