#include "noise_table.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::segmentation
{
const NoiseTable& NoiseTable::instance()
{
  static const NoiseTable TABLE;
  return TABLE;
}

NoiseTable::NoiseTable() : sigma_(ROWS * COLUMNS)
{
  constexpr double MAX_THETA_RAD = 1.4835298641951802;  // 85 deg
  for (int row = 0; row < ROWS; ++row)
    for (int column = 0; column < COLUMNS; ++column)
    {
      const double z_m = (row + 0.5) / PER_METRE;
      const double theta_rad = std::min(MAX_THETA_RAD, std::acos((column + 0.5) / COLUMNS));
      sigma_[row * COLUMNS + column] = static_cast<float>(rgbd::axialSigma_m(z_m, theta_rad));
    }
}

}  // namespace object_modelling::segmentation
