#pragma once

#include <opencv2/core.hpp>

namespace object_modelling::rgbd
{
/// Depth (m) at a sub-pixel position, bilinear, where its four neighbours are one surface: they differ by at most
/// `max_step_ratio` of their depth. NaN elsewhere, at holes and outside the image.
float sampleDepth_m(const cv::Mat& depth_m, float u_px, float v_px, float max_step_ratio = 0.015F);

}  // namespace object_modelling::rgbd
