#include "object_modelling/pipeline/model_object.h"

#include <utility>

#include "object_modelling/base/options.h"

namespace object_modelling::pipeline
{
namespace
{
void throwUnlessOk(const std::string& stage, const base::Status& status)
{
  if (!status.ok())
    throw base::Error(status.code, stage + ": " + status.message);
}
}  // namespace

ModelOutcome modelObject(ModelStages& stages, const std::vector<std::string>& session_ids, bool again,
                         base::JobControl& control)
{
  ModelOutcome outcome;
  std::vector<std::string> unrefined, unsegmented;
  for (const std::string& id : session_ids)
  {
    const keyframes::Session session = stages.session(id);
    if (again || !session.refined.done())
      unrefined.push_back(id);
    if (again || !session.segmented.done())
      unsegmented.push_back(id);
    if (!again && session.refined.done() && session.segmented.done())
      outcome.unchanged.push_back(id);
  }
  for (const std::string& id : unrefined)
    stages.refine(id, control);
  for (const std::string& id : unsegmented)
    stages.segment(id, control);
  outcome.aligned = stages.align(session_ids, control);
  outcome.status = outcome.aligned.status;
  if (!outcome.status.ok())
    return outcome;
  outcome.built = stages.build(outcome.aligned, control);
  outcome.status = outcome.built->status;
  return outcome;
}

std::vector<std::string> LocalStagesOptions::violations() const
{
  base::OptionsCheck check("model_object");
  check.include(refinement.violations());
  check.include(segmentation.violations());
  check.include(align.violations());
  check.include(build.violations());
  return check.violations();
}

LocalStages::LocalStages(keyframes::SessionStore& store, database::ObjectDatabase& database, LocalStagesOptions options)
    : store_(store), database_(database), options_(std::move(options))
{
  base::checked(options_);
}

keyframes::Session LocalStages::session(const std::string& session_id)
{
  return store_.session(session_id);
}

void LocalStages::refine(const std::string& session_id, base::JobControl& control)
{
  const SessionRefinement refined = refineSessionBy(store_, session_id, options_.refinement, control);
  onRefined(session_id, refined);
  throwUnlessOk("refinement of session '" + session_id + "'", refined.status);
}

void LocalStages::segment(const std::string& session_id, base::JobControl& control)
{
  const SegmentReport segmented =
      segmentSession(store_, session_id, options_.seed_point_session, options_.segmentation, control);
  onSegmented(segmented);
  throwUnlessOk("segmentation of session '" + session_id + "'", segmented.status);
}

alignment::AlignmentResult LocalStages::align(const std::vector<std::string>& session_ids, base::JobControl& control)
{
  return alignSessions(store_, session_ids, options_.align, control);
}

BuildReport LocalStages::build(const alignment::AlignmentResult& aligned, base::JobControl& control)
{
  BuildOptions options = options_.build;
  options.left_out = leftOutOf(aligned);
  return buildObject(store_, database_, options_.object_id, options_.name, aligned.placements, options, control);
}

}  // namespace object_modelling::pipeline
