#pragma once

#include "object_modelling/registration/pair_icp.h"
#include "object_modelling/registration/pair_measure.h"

namespace object_modelling::registration
{
/// Moves a pose that is near into place by shape and colour, with many points both ways, and measures it there.
PairQuality refinePairPose(const PartPair& pair, Eigen::Isometry3f* T_a_b);

}  // namespace object_modelling::registration
