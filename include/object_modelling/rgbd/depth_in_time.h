#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/pinhole_camera.h"

namespace object_modelling::rgbd
{
/// Depth image as the camera would have seen it from another place near by, where it was when the colour image was
/// taken: most cameras expose the two one after the other. `depth_m`: CV_32FC1, NaN where missing. Motions of a few
/// pixels; what they uncover is missing.
cv::Mat moveDepth(const cv::Mat& depth_m, const geometry::PinholeCamera& camera,
                  const Eigen::Isometry3d& T_color_depth);

}  // namespace object_modelling::rgbd
