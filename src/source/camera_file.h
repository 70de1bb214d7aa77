#pragma once

#include <string>

#include "object_modelling/geometry/pinhole_camera.h"

namespace object_modelling::source
{
struct CameraFile
{
  geometry::PinholeCamera camera;
  double depth_unit_m = 0;
  std::string frame_id;
};

/// camera.yaml of a recording. Throws base::Error: NOT_FOUND without the file, BAD_INPUT naming the key.
CameraFile readCameraFile(const std::string& path);

}  // namespace object_modelling::source
