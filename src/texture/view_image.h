#pragma once

#include <opencv2/core.hpp>

#include "object_modelling/geometry/image_sampling.h"
#include "object_modelling/texture/texture_view.h"

namespace object_modelling::texture
{
/// The part of an image that shows the object, its exposure corrected.
struct ViewImage
{
  cv::Mat bgr;                        ///< CV_32FC3
  Eigen::Vector2f corner_px{ 0, 0 };  ///< of its first pixel in the whole colour image

  /// Bilinear at a pixel of the whole image; places outside count as the rim.
  Eigen::Vector3f at(const Eigen::Vector2f& pixel) const { return geometry::colorAt(bgr, pixel - corner_px); }
};

/// Image of a view times its gains, at least two pixels wide and high.
ViewImage correctedImage(const TextureView& view, const Eigen::Vector3f& gains);

}  // namespace object_modelling::texture
