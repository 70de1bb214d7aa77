#pragma once

#include <opencv2/core.hpp>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::segmentation
{
/// A frame thinned out to about 213x160, with normals: enough to find planes, a ninth of the work. Pixel (u, v) is
/// pixel (u * step, v * step) of the frame.
struct WorkingImage
{
  int step = 1;
  rgbd::Frame frame;  ///< depth, camera and noise model only
  cv::Mat normals;    ///< CV_32FC3
};

/// Pixels under `ignored` (CV_8UC1 of the frame's size, may be empty) are taken as missing.
WorkingImage makeWorkingImage(const rgbd::Frame& frame, const cv::Mat& ignored = {});

}  // namespace object_modelling::segmentation
