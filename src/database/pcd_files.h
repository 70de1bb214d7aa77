#pragma once

#include <string>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::database
{
/// The whole image as an organised cloud (PointXYZRGB, binary_compressed) in the camera frame; NaN where depth is
/// missing. Throws base::Error (STORAGE).
void writeOrganizedCloud(const std::string& path, const rgbd::Frame& frame);

}  // namespace object_modelling::database
