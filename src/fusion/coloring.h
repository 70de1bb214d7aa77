#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "prepared_view.h"
#include "surfel_fit.h"

namespace object_modelling::fusion
{
/// RGB of every surfel: weighted mean over the views that see it best (near, frontal, away from the mask's rim), read
/// between pixels; the exposure of each view is brought to the common mean first.
std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colorSurfels(const std::vector<PreparedView>& views,
                                                            const std::vector<Surfel>& surfels,
                                                            double consistency_sigmas);

}  // namespace object_modelling::fusion
