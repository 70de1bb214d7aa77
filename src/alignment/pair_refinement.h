#pragma once

#include "pair_icp.h"
#include "pair_measure.h"

namespace object_modelling::alignment
{
/// Moves a pose that is near into place by shape and colour, with many points both ways, and measures it there.
PairQuality refinePose(const PartPair& pair, Eigen::Isometry3f* T_a_b);

}  // namespace object_modelling::alignment
