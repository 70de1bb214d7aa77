#pragma once

#include <opencv2/core.hpp>

#include "object_modelling/geometry/plane.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::segmentation
{
struct PedestalOptions
{
  double noise_scale = 1;        ///< ratio of the plane's measured noise to the noise model's
  double min_size_m = 0.2;       ///< what is smaller is a saucer, and part of the object
  double max_size_m = 0.6;       ///< what is larger is a table
  double max_level_ratio = 0.3;  ///< of the surroundings that go on at the plane's height
};

/// Turntable, tray or stool under an object: the part of its support plane (in the camera frame) that carries it, if
/// that ends with a step down all round. CV_8UC1 without the object and without a margin along the rim, whose outline
/// in the image is no mark on it; empty where there is none.
cv::Mat findPedestal(const rgbd::Frame& frame, const geometry::Plane& plane_camera, const cv::Mat& object,
                     const PedestalOptions& options);

}  // namespace object_modelling::segmentation
