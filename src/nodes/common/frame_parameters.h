#pragma once

#include <string>

#include "object_modelling/base/options.h"
#include "object_modelling/rgbd/frame_builder.h"

namespace object_modelling::nodes
{
/// Keys frame/... of every node that takes images.
template <typename Reader>
void read(Reader& reader, rgbd::FrameBuilderOptions* options)
{
  reader.read("frame/max_stamp_difference_s", options->max_stamp_difference_s);
  reader.read("frame/min_depth_ratio", options->min_depth_ratio);
  reader.read("frame/min_depth_m", options->min_depth_m);
  reader.read("frame/max_depth_m", options->max_depth_m);
}

inline void requireFrameId(base::OptionsCheck& check, const std::string& field, const std::string& frame_id)
{
  check.require(field, !frame_id.empty() && frame_id.front() != '/', "must be a frame id without leading slash");
}

}  // namespace object_modelling::nodes
