#include "session_aligner.h"

#include <algorithm>

#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "session_list.h"

namespace object_modelling::nodes
{
namespace
{
constexpr std::size_t REPORTED_CANDIDATES = 3;

object_modelling::AlignmentCandidate toMessage(const alignment::PairCandidate& candidate)
{
  object_modelling::AlignmentCandidate message;
  message.kind = alignment::nameOf(candidate.kind);
  message.a_from_b = ros_bridge::toPoseMessage(candidate.T_a_b);
  message.overlap_ratio = candidate.quality.overlap_ratio;
  message.fsv_ratio = candidate.quality.fsv_ratio;
  message.rmse_m = candidate.quality.rmse_m;
  message.contact_gap_m = candidate.quality.contact_gap_m;
  message.color_agreement = candidate.quality.color_agreement;
  message.texture = candidate.quality.texture;
  message.probability = candidate.quality.probability;
  return message;
}

object_modelling::AlignmentEdge toMessage(const alignment::AlignmentEdge& edge)
{
  object_modelling::AlignmentEdge message;
  message.session_a = edge.session_a;
  message.session_b = edge.session_b;
  message.accepted = edge.accepted;
  message.used = edge.used;
  message.reason = edge.reason;
  for (std::size_t i = 0; i < std::min(edge.candidates.size(), REPORTED_CANDIDATES); ++i)
    message.candidates.push_back(toMessage(edge.candidates[i]));
  return message;
}
}  // namespace

SessionAligner::SessionAligner(ros::NodeHandle& node, ros::NodeHandle& private_node,
                               const SessionAlignerOptions& options)
    : options_(options),
      store_(node, options.store),
      server_(
          private_node, "align",
          [](const object_modelling::AlignGoal& goal) { return "align " + joined(goal.session_ids); },
          [this](const object_modelling::AlignGoal& goal, base::JobControl& control) { return align(goal, control); })
{
}

object_modelling::AlignResult SessionAligner::align(const object_modelling::AlignGoal& goal, base::JobControl& control)
{
  requireSessions(goal.session_ids);
  const alignment::AlignmentResult aligned = pipeline::alignSessions(store_, goal.session_ids, options_.align, control);
  object_modelling::AlignResult result;
  result.status = ros_bridge::toMessage(aligned.status);
  for (const alignment::SessionPlacement& placement : aligned.placements)
  {
    object_modelling::SessionPlacement message;
    message.session_id = placement.session_id;
    message.reference_from_session = ros_bridge::toPoseMessage(placement.T_reference_session);
    result.placements.push_back(message);
  }
  result.left_out = aligned.left_out;
  for (const alignment::AlignmentEdge& edge : aligned.edges)
    result.edges.push_back(toMessage(edge));
  return result;
}

}  // namespace object_modelling::nodes
