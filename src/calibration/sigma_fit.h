#pragma once

#include <vector>

#include "object_modelling/calibration/noise_calibration.h"
#include "wall_view.h"

namespace object_modelling::calibration
{
/// Bins of 0.1 m and 5 deg that have enough blocks.
std::vector<NoiseBin> binned(const std::vector<WallBlock>& blocks, int min_blocks_per_bin);

/// Fits the axial coefficients to the bins, by least squares on relative errors; those that the bins do not span keep
/// what they are in `calibration->model`. Fills bins[].fitted_sigma_m and adds to `coefficients`.
void fitAxialSigma(const NoiseCalibrationOptions& options, NoiseCalibration* calibration);

}  // namespace object_modelling::calibration
