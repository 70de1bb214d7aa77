#include "session_aligner.h"

#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "session_list.h"

namespace object_modelling::nodes
{
namespace
{
object_modelling::AlignmentEdge toMessage(const alignment::AlignmentEdge& edge)
{
  object_modelling::AlignmentEdge message;
  message.session_a = edge.session_a;
  message.session_b = edge.session_b;
  message.a_from_b = ros_bridge::toPoseMessage(edge.T_a_b);
  message.overlap_ratio = edge.overlap_ratio;
  message.fsv_ratio = edge.fsv_ratio;
  message.confidence = edge.confidence;
  return message;
}
}  // namespace

SessionAligner::SessionAligner(ros::NodeHandle& node, ros::NodeHandle& private_node,
                               const SessionAlignerOptions& options)
    : store_(node, options.store),
      server_(
          private_node, "align",
          [](const object_modelling::AlignGoal& goal) { return "align " + joined(goal.session_ids); },
          [this](const object_modelling::AlignGoal& goal, base::JobControl& control) { return align(goal, control); })
{
}

object_modelling::AlignResult SessionAligner::align(const object_modelling::AlignGoal& goal, base::JobControl& control)
{
  requireSessions(goal.session_ids);
  const alignment::AlignmentResult aligned = pipeline::alignSessions(store_, goal.session_ids, control);
  object_modelling::AlignResult result;
  result.status = ros_bridge::toMessage(aligned.status);
  for (const alignment::SessionPlacement& placement : aligned.placements)
  {
    object_modelling::SessionPlacement message;
    message.session_id = placement.session_id;
    message.reference_from_session = ros_bridge::toPoseMessage(placement.T_reference_session);
    result.placements.push_back(message);
  }
  for (const alignment::AlignmentEdge& edge : aligned.edges)
    result.edges.push_back(toMessage(edge));
  return result;
}

}  // namespace object_modelling::nodes
