#pragma once

#include <opencv2/core.hpp>

namespace object_modelling::benchmark_texture
{
/// Peak signal-to-noise ratio (dB, peak 255) of `image` against `reference` (both CV_8UC3) over the pixels of `mask`,
/// after the gain per channel (and offset, if asked for) that fits best. NaN without pixels.
double psnrAfterFit_dB(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& mask, bool with_offset,
                       cv::Mat* fitted = nullptr);

/// The same where a gain may change with the surface's direction, as diffuse light does: image = reference * (a + b.n)
/// + c per channel, fitted to the image. `normals` CV_32FC3.
double psnrUnderLight_dB(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& normals, const cv::Mat& mask,
                         cv::Mat* fitted = nullptr);

}  // namespace object_modelling::benchmark_texture
