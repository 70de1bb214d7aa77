#include "alignment_message.h"

#include <algorithm>

#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
namespace
{
object_modelling::AlignmentCandidate toMessage(const alignment::PairCandidate& candidate)
{
  object_modelling::AlignmentCandidate message;
  message.kind = alignment::nameOf(candidate.kind);
  message.a_from_b = ros_bridge::toPoseMessage(candidate.T_a_b);
  message.overlap_ratio = candidate.quality.overlap_ratio;
  message.fsv_ratio = candidate.quality.fsv_ratio;
  message.rmse_m = candidate.quality.rmse_m;
  message.contact_gap_m = candidate.quality.contact_gap_m;
  message.foot_m = candidate.quality.foot_m;
  message.turn_rad = candidate.quality.turn_rad;
  message.roughness_m = candidate.quality.roughness_m;
  message.color_agreement = candidate.quality.color_agreement;
  message.texture = candidate.quality.texture;
  message.light_variance = candidate.quality.light_variance;
  message.edge_agreement = candidate.quality.edge_agreement;
  message.edge_strength = candidate.quality.edge_strength;
  message.features_upheld = candidate.quality.features_upheld;
  message.probability = candidate.quality.probability;
  message.same_object_probability = candidate.same_object_probability;
  return message;
}

std::uint8_t toMessage(alignment::Decision decision)
{
  switch (decision)
  {
    case alignment::Decision::ACCEPTED:
      return object_modelling::AlignmentEdge::ACCEPTED;
    case alignment::Decision::REFUSED:
      return object_modelling::AlignmentEdge::REFUSED;
    case alignment::Decision::AUTOMATIC:
      break;
  }
  return object_modelling::AlignmentEdge::AUTOMATIC;
}
}  // namespace

object_modelling::AlignmentEdge toMessage(const alignment::AlignmentEdge& edge)
{
  object_modelling::AlignmentEdge message;
  message.session_a = edge.session_a;
  message.session_b = edge.session_b;
  message.decision = toMessage(edge.decision);
  message.accepted = edge.accepted;
  message.used = edge.used;
  message.reason = edge.reason;
  for (std::size_t i = 0; i < std::min(edge.candidates.size(), SHOWN_CANDIDATES); ++i)
    message.candidates.push_back(toMessage(edge.candidates[i]));
  return message;
}

}  // namespace object_modelling::nodes
