#pragma once

#include <string>

#include "data_path.h"
#include "object_modelling/base/options.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/rgbd/noise_model_file.h"

namespace object_modelling::nodes
{
/// Keys frame/... and noise_model of every node that takes images. Throws base::Error as rgbd::loadNoiseModel does.
template <typename Reader>
void read(Reader& reader, rgbd::FrameBuilderOptions* options)
{
  reader.read("frame/max_stamp_difference_s", options->max_stamp_difference_s);
  reader.read("frame/min_depth_ratio", options->min_depth_ratio);
  reader.read("frame/min_depth_m", options->min_depth_m);
  reader.read("frame/max_depth_m", options->max_depth_m);
  std::string noise_model;
  reader.read("noise_model", noise_model);
  if (!noise_model.empty())
    options->noise_model = rgbd::loadNoiseModel(dataPath(noise_model, ""));
}

inline void requireFrameId(base::OptionsCheck& check, const std::string& field, const std::string& frame_id)
{
  check.require(field, !frame_id.empty() && frame_id.front() != '/', "must be a frame id without leading slash");
}

}  // namespace object_modelling::nodes
