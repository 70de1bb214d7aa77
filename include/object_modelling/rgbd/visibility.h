#pragma once

#include <cmath>

#include <opencv2/core.hpp>

#include "object_modelling/geometry/projection.h"

namespace object_modelling::rgbd
{
/// Visibility of a point in a depth image.
enum class Visibility
{
  OUTSIDE,   ///< it does not project into the image
  UNKNOWN,   ///< nothing was measured there
  IN_FRONT,  ///< the camera looks through it: the measured surface is farther
  ON,        ///< it is on the measured surface, within the tolerance
  BEHIND     ///< the measured surface hides it
};

/// `z_m`: depth of the point; `measured_m`: of the image where it projects, not finite or <= 0 where missing. Both, and
/// the tolerance, of one scalar type.
template <typename Scalar>
Visibility visibilityOf(Scalar z_m, Scalar measured_m, Scalar tolerance_m)
{
  if (!std::isfinite(measured_m) || measured_m <= 0)
    return Visibility::UNKNOWN;
  if (measured_m > z_m + tolerance_m)
    return Visibility::IN_FRONT;
  return measured_m < z_m - tolerance_m ? Visibility::BEHIND : Visibility::ON;
}

/// `depth_m`: CV_32FC1, of the size of the camera that the point was projected into. Depths are compared in the
/// precision of the tolerance.
template <typename Scalar, typename Tolerance>
Visibility visibilityOf(const geometry::Projection<Scalar>& at, const cv::Mat& depth_m, Tolerance tolerance_m)
{
  if (!at.inside)
    return Visibility::OUTSIDE;
  return visibilityOf<Tolerance>(at.z_m, depth_m.at<float>(at.row, at.column), tolerance_m);
}

}  // namespace object_modelling::rgbd
