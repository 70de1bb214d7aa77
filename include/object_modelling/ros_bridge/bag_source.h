#pragma once

#include <memory>
#include <string>
#include <vector>

#include "object_modelling/source/frame_source.h"

namespace object_modelling::ros_bridge
{
/// Topics of a recording; what is empty is found by message type, encoding and name if only one topic fits.
struct BagTopics
{
  std::string color;
  std::string depth;
  std::string camera_info;
  std::string object_mask;
};

struct BagSourceOptions
{
  BagTopics topics;
  double max_stamp_difference_s = 0.02;  ///< colour and depth further apart than this are not one frame
  std::vector<std::string> violations() const;
};

/// RGB-D recording in a ROS bag. A colour topic with "rect" in its name is read with P of its CameraInfo, any other
/// with K and D. size() is the number of colour images, an upper bound of the frames. Throws base::Error: NOT_FOUND for
/// a missing file or topic, BAD_INPUT for a truncated or unindexed bag, for topics that are ambiguous (listing the
/// candidates) and for depth that is not registered to colour.
std::unique_ptr<source::FrameSource> openBag(const std::string& path, const BagSourceOptions& options = {});

}  // namespace object_modelling::ros_bridge
