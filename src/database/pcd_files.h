#pragma once

#include <string>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::database
{
/// Throws base::Error (BAD_INPUT) that names the file and the reason.
[[noreturn]] void damaged(const std::string& path, const std::string& reason);

/// The whole image as an organised cloud (PointXYZRGB, binary_compressed) in the camera frame; NaN where depth is
/// missing. Throws base::Error (STORAGE).
void writeOrganizedCloud(const std::string& path, const rgbd::Frame& frame);

}  // namespace object_modelling::database
