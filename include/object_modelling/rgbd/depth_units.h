#pragma once

#include <opencv2/core.hpp>

namespace object_modelling::rgbd
{
/// The one conversion from stored depth images to metres. Accepts CV_16UC1 in units of `unit_m` (0 missing; REP 118: 1
/// mm) and CV_32FC1 in metres (NaN, inf, <= 0 missing; unit_m ignored). Returns CV_32FC1 metres, NaN missing. Throws
/// base::Error (BAD_INPUT) for any other type.
cv::Mat depthInMeters(const cv::Mat& depth, double unit_m);

/// Back to CV_16UC1 in units of `unit_m`, 0 for missing or out of range; rounds to nearest.
cv::Mat depthAs16Bit(const cv::Mat& depth_m, double unit_m);

}  // namespace object_modelling::rgbd
