#pragma once

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::segmentation
{
/// Depth, camera and noise model of the part of the frame inside `area`, without a copy.
inline rgbd::Frame cropped(const rgbd::Frame& frame, const cv::Rect& area)
{
  rgbd::Frame crop;
  crop.depth_m = frame.depth_m(area);
  crop.camera = frame.camera;
  crop.noise_model = frame.noise_model;
  crop.camera.width = area.width;
  crop.camera.height = area.height;
  crop.camera.cx -= area.x;
  crop.camera.cy -= area.y;
  return crop;
}

}  // namespace object_modelling::segmentation
