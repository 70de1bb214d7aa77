#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "surfel_fit.h"
#include "view.h"

namespace object_modelling::fusion
{
/// RGB of every surfel: weighted mean over the views that see it best (near, frontal, away from the mask's rim), read
/// between pixels; the exposure of each view is brought to the common mean first. The colour images are shifted by
/// `color_offset_px` against the depth images.
std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colourSurfels(const std::vector<View>& views,
                                                             const std::vector<Surfel>& surfels,
                                                             double consistency_sigmas,
                                                             const Eigen::Vector2d& color_offset_px);

}  // namespace object_modelling::fusion
