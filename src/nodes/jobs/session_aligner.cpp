#include "session_aligner.h"

#include "alignment_message.h"
#include "left_out_message.h"
#include "placement_message.h"
#include "session_list.h"

namespace object_modelling::nodes
{
SessionAligner::SessionAligner(ros::NodeHandle& node, ros::NodeHandle& private_node,
                               const SessionAlignerOptions& options)
    : options_(options),
      name_(private_node.getNamespace()),
      store_(node, options.store),
      review_(node, private_node, store_, options),
      server_(
          private_node, "align",
          [](const object_modelling::AlignGoal& goal) { return "align " + joined(goal.session_ids); },
          [this](const object_modelling::AlignGoal& goal, base::JobControl& control) { return align(goal, control); })
{
}

// The action server is taken down here: its templates cost the compiler seconds wherever they are seen.
SessionAligner::~SessionAligner() = default;

namespace
{
pipeline::Required requiredBy(const object_modelling::AlignGoal& goal)
{
  switch (goal.required)
  {
    case object_modelling::AlignGoal::REQUIRE_TWO:
      return pipeline::Required::TWO;
    case object_modelling::AlignGoal::REQUIRE_ONE:
      return pipeline::Required::ONE;
    case object_modelling::AlignGoal::REQUIRE_ALL:
      return pipeline::Required::ALL;
    default:
      throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                        "required " + std::to_string(goal.required) + " is none of 0 (two), 1 (one), 2 (all sessions)");
  }
}
}  // namespace

alignment::AlignmentResult SessionAligner::aligned(const object_modelling::AlignGoal& goal, base::JobControl& control)
{
  pipeline::AlignOptions options = options_.align;
  options.use_known = options.use_known && !goal.anew;
  options.required = requiredBy(goal);
  if (goal.session_ids.size() == 1)
    return pipeline::alignStoredSessions(store_, goal.session_ids, options, control);
  std::vector<registration::PartialModel> parts = pipeline::loadParts(store_, goal.session_ids, options.part, control);
  alignment::AlignmentResult result = pipeline::alignStoredParts(store_, parts, options, control);
  if (!result.left_out.empty())
    result.status.message += "; " + remedyFor(result);
  review_.show(result.edges, std::move(parts));
  return result;
}

std::string SessionAligner::remedyFor(const alignment::AlignmentResult& result) const
{
  const std::string look = "look at the pair in rviz ('roslaunch object_modelling alignment_review.launch')";
  const alignment::AlignmentEdge* pair = pipeline::joiningPair(result);
  if (pair == nullptr)
    return look + ", click the same three spots on both and build again, or record sessions that see more in common";
  return look + ", accept the candidate that is right ('rosservice call " + name_ +
         "/accept \"{session_a: " + pair->session_a + ", session_b: " + pair->session_b +
         ", candidate: 0}\"') or click the same three spots on both, and build again";
}

object_modelling::AlignResult SessionAligner::align(const object_modelling::AlignGoal& goal, base::JobControl& control)
{
  requireSessions(goal.session_ids);
  const alignment::AlignmentResult found = aligned(goal, control);
  object_modelling::AlignResult result;
  result.status = ros_bridge::toMessage(found.status);
  for (const alignment::SessionPlacement& placement : found.placements)
    result.placements.push_back(placementMessage(placement));
  result.left_out = found.left_out;
  for (const alignment::AlignmentEdge& edge : found.edges)
    result.edges.push_back(toMessage(edge));
  for (const database::LeftOutSession& session : pipeline::leftOutOf(found))
    result.left_out_reasons.push_back(leftOutMessage(session));
  return result;
}

}  // namespace object_modelling::nodes
