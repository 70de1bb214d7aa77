#pragma once

#include <vector>

#include "object_modelling/calibration/noise_calibration.h"
#include "wall_view.h"

namespace object_modelling::calibration
{
/// Depth bias against distance from distances that were measured by other means: the depth of a wall that is measured
/// at d instead of D is wrong by the share 1 - D / d, where it is faced: only
/// frames within 25 deg of that count. As many coefficients as the distances carry: constant
/// for one place, with a linear term for two, quadratic for three that span a metre. Without distances the bias keeps
/// its default, and the report gives the reason. Adds to `coefficients`.
void fitBias(const std::vector<WallView>& views, const std::vector<MeasuredDistance>& distances,
             NoiseCalibration* calibration);

}  // namespace object_modelling::calibration
