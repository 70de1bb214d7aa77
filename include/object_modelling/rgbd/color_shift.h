#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::rgbd
{
/// The grey image in the pixels of the depth image, for a pixel of a point in the colour image minus its pixel in the
/// depth image of `color_offset_px`. The image itself if that is next to nothing.
cv::Mat ontoDepth(const cv::Mat& gray, const Eigen::Vector2d& color_offset_px);

}  // namespace object_modelling::rgbd
