#include "action_stages.h"

#include <utility>

#include "../jobs/left_out_message.h"
#include "../jobs/placement_message.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
base::Status statusOf(const std::string& stage, const object_modelling::Status& message)
{
  base::Status status = ros_bridge::fromMessage(message);
  if (!status.ok())
    status.message = stage + ": " + status.message;
  return status;
}

void throwUnlessOk(const base::Status& status)
{
  if (!status.ok())
    throw base::Error(status.code, status.message);
}
}  // namespace

ActionStages::ActionStages(JobClients& jobs, keyframes::SessionStore& store,
                           const object_modelling::BuildObject::Request& request, OnStage on_stage)
    : jobs_(jobs), store_(store), request_(request), on_stage_(std::move(on_stage))
{
}

void ActionStages::refine(const std::vector<std::string>& session_ids, base::JobControl& control)
{
  object_modelling::RefineGoal goal;
  goal.session_ids = session_ids;
  throwUnlessOk(statusOf("refine", jobs_.refine.run(goal, control).status));
}

void ActionStages::segment(const std::vector<std::string>& session_ids, base::JobControl& control)
{
  for (std::size_t i = 0; i < session_ids.size(); ++i)
  {
    const std::string which = std::to_string(i + 1) + " of " + std::to_string(session_ids.size());
    object_modelling::SegmentSessionGoal goal;
    goal.session_id = session_ids[i];
    throwUnlessOk(statusOf("segment", jobs_.segment.run(goal, control, session_ids.size() == 1 ? "" : which).status));
  }
}

pipeline::AlignedSessions ActionStages::align(const std::vector<std::string>& session_ids, base::JobControl& control)
{
  using object_modelling::AlignGoal;
  AlignGoal goal;
  goal.session_ids = session_ids;
  goal.required = request_.require_all ? AlignGoal::REQUIRE_ALL : AlignGoal::REQUIRE_ONE;
  const object_modelling::AlignResult result = jobs_.align.run(goal, control);
  pipeline::AlignedSessions aligned;
  aligned.status = statusOf("align", result.status);
  if (!aligned.status.ok())
    return aligned;
  aligned.placements = placementsFrom(result.placements);
  for (const object_modelling::SessionLeftOut& session : result.left_out_reasons)
    aligned.left_out.push_back(leftOutFrom(session));
  return aligned;
}

base::Status ActionStages::build(const pipeline::AlignedSessions& aligned, base::JobControl& control)
{
  object_modelling::BuildGoal goal;
  goal.object_id = request_.object_id;
  goal.name = request_.name;
  goal.replace = request_.replace;
  for (const alignment::SessionPlacement& placement : aligned.placements)
    goal.placements.push_back(placementMessage(placement));
  for (const database::LeftOutSession& session : aligned.left_out)
    goal.left_out.push_back(leftOutMessage(session));
  const object_modelling::BuildResult result = jobs_.build.run(goal, control);
  built_ = result.built;
  return statusOf("build", result.status);
}

}  // namespace object_modelling::nodes
