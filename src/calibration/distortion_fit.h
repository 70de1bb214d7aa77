#pragma once

#include <vector>

#include "object_modelling/calibration/noise_calibration.h"
#include "wall_view.h"

namespace object_modelling::calibration
{
/// Smooth distortion from the offsets of the blocks from their frame's plane. A wall shows what is not itself a plane:
/// each frame's own plane is a nuisance with three parameters, taken out of the equations (Schur complement); a prior
/// of 0 and of smoothness decides what is left, a share of depth that is the same everywhere among it. Kept only if it
/// makes frames flatter that it was not fitted to. Sets model.depth_distortion_ratio and flatness_..., adds to
/// `coefficients`.
void fitDistortion(const std::vector<WallView>& views, int width_px, int height_px, NoiseCalibration* calibration);

}  // namespace object_modelling::calibration
