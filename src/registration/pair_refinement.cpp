#include "object_modelling/registration/pair_refinement.h"

namespace object_modelling::registration
{
PairQuality refinePairPose(const PartPair& pair, Eigen::Isometry3f* T_a_b)
{
  const MatchedSurface &a = pair.a, &b = pair.b;
  PairIcpOptions icp;
  icp.coarse = false;
  icp.gate_m = 2.5 * a.model.spacing_m;
  icp.last_gate_m = a.model.spacing_m;
  icp.iterations = 12;
  icp.color = ColorDetail::BLURRED;
  *T_a_b = alignByIcp(a, b, *T_a_b, icp);
  icp.color = ColorDetail::SHARP;
  icp.gate_m = icp.last_gate_m;
  *T_a_b = alignByIcp(a, b, *T_a_b, icp);
  return measurePair(pair, *T_a_b, true);
}

}  // namespace object_modelling::registration
