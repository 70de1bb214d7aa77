#include "session_aligner.h"

#include "alignment_message.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "session_list.h"

namespace object_modelling::nodes
{
SessionAligner::SessionAligner(ros::NodeHandle& node, ros::NodeHandle& private_node,
                               const SessionAlignerOptions& options)
    : options_(options),
      store_(node, options.store),
      review_(node, private_node, store_, options),
      server_(
          private_node, "align",
          [](const object_modelling::AlignGoal& goal) { return "align " + joined(goal.session_ids); },
          [this](const object_modelling::AlignGoal& goal, base::JobControl& control) { return align(goal, control); })
{
}

alignment::AlignmentResult SessionAligner::aligned(const object_modelling::AlignGoal& goal, base::JobControl& control)
{
  pipeline::AlignOptions options = options_.align;
  options.use_known = options.use_known && !goal.anew;
  if (goal.session_ids.size() == 1)
    return pipeline::alignSessions(store_, goal.session_ids, options, control);
  std::vector<alignment::PartialModel> parts = pipeline::loadParts(store_, goal.session_ids, options.part, control);
  alignment::AlignmentResult result = pipeline::alignParts(store_, parts, options, control);
  review_.show(result.edges, std::move(parts));
  return result;
}

object_modelling::AlignResult SessionAligner::align(const object_modelling::AlignGoal& goal, base::JobControl& control)
{
  requireSessions(goal.session_ids);
  const alignment::AlignmentResult found = aligned(goal, control);
  object_modelling::AlignResult result;
  result.status = ros_bridge::toMessage(found.status);
  for (const alignment::SessionPlacement& placement : found.placements)
  {
    object_modelling::SessionPlacement message;
    message.session_id = placement.session_id;
    message.reference_from_session = ros_bridge::toPoseMessage(placement.T_reference_session);
    result.placements.push_back(message);
  }
  result.left_out = found.left_out;
  for (const alignment::AlignmentEdge& edge : found.edges)
    result.edges.push_back(toMessage(edge));
  return result;
}

}  // namespace object_modelling::nodes
