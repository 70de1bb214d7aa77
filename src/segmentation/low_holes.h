#pragma once

#include <opencv2/core.hpp>

#include "object_modelling/geometry/plane.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::segmentation
{
/// Adds to an object's mask the enclosed parts that lie too low to be separated from the support pixel by pixel, but
/// whose median height is above half of `min_height_m`: the floor of a bowl, of a mug. A table seen through a handle
/// stays out.
void fillLowHoles(const rgbd::Frame& frame, const geometry::Plane& plane_camera, double min_height_m,
                  double max_height_m, const cv::Rect& rect, cv::Mat* mask);

}  // namespace object_modelling::segmentation
