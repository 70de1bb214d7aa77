#pragma once

#include <cmath>

namespace object_modelling::rgbd
{
/// What a depth image tells of a point that projects into it.
enum class Visibility
{
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

}  // namespace object_modelling::rgbd
