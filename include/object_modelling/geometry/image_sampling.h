#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::geometry
{
/// Bilinear, of CV_8UC3 or CV_32FC3 at least two pixels wide and high; places outside count as the image's rim.
Eigen::Vector3f colorAt(const cv::Mat& image, const Eigen::Vector2f& pixel);

}  // namespace object_modelling::geometry
