#include "object_modelling/pipeline/model_object.h"

#include <algorithm>
#include <chrono>
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

bool contains(const std::vector<std::string>& ids, const std::string& id)
{
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

void append(const std::string& part, const std::string& separator, std::string* text)
{
  *text += (text->empty() ? "" : separator) + part;
}

/// First that the object is partial or failed, then why sessions were left out and what to do.
void addReasons(const AlignedSessions& aligned, base::Status* status)
{
  const bool wanted = status->ok() || (!aligned.left_out.empty() && status->code != base::StatusCode::CANCELLED);
  if (wanted && !aligned.status.message.empty())
    append(aligned.status.message, "; ", &status->message);
}

/// One call of modelObject().
class ModelRun
{
public:
  ModelRun(ModelStages& stages, const std::vector<std::string>& session_ids, bool again, base::JobControl& control)
      : stages_(stages), session_ids_(session_ids), again_(again), control_(control)
  {
  }

  ModelOutcome run()
  {
    std::vector<std::string> unrefined, unsegmented;
    stage("refine",
          [&]
          {
            unrefined = pending(&keyframes::Session::refined);
            if (!unrefined.empty())
              stages_.refine(unrefined, control_);
          });
    stage("segment",
          [&]
          {
            unsegmented = pending(&keyframes::Session::segmented);
            if (!unsegmented.empty())
              stages_.segment(unsegmented, control_);
          });
    for (const std::string& id : session_ids_)
      if (!contains(unrefined, id) && !contains(unsegmented, id))
        outcome_.unchanged.push_back(id);
    AlignedSessions aligned;
    stage("align", [&] { aligned = stages_.align(session_ids_, control_); });
    outcome_.status = aligned.status;
    if (aligned.status.ok())
      stage("build", [&] { build(aligned); });
    return outcome_;
  }

private:
  template <typename Work>
  void stage(const std::string& name, Work&& work)
  {
    stages_.onStage(name);
    control_.checkCancelled();
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
    outcome_.stages.push_back({ name, duration.count() });
  }

  /// Looked up when the stage begins: a person may have chosen the object while the one before it ran.
  std::vector<std::string> pending(keyframes::StageMark keyframes::Session::*mark)
  {
    std::vector<std::string> left;
    std::string done;
    for (const std::string& id : session_ids_)
      if (again_ || !(stages_.session(id).*mark).done())
        left.push_back(id);
      else
        append(id, ", ", &done);
    if (!done.empty())
      control_.report("as before: " + done, 0, 0);
    return left;
  }

  void build(const AlignedSessions& aligned)
  {
    try
    {
      outcome_.status = stages_.build(aligned, control_);
    }
    catch (const base::Cancelled&)
    {
      throw;
    }
    catch (const base::Error& error)
    {
      base::Status status = error.status();
      addReasons(aligned, &status);
      throw base::Error(status.code, status.message);
    }
    outcome_.built = outcome_.status.ok();
    addReasons(aligned, &outcome_.status);
  }

  ModelStages& stages_;
  const std::vector<std::string>& session_ids_;
  bool again_;
  base::JobControl& control_;
  ModelOutcome outcome_;
};
}  // namespace

ModelOutcome modelObject(ModelStages& stages, const std::vector<std::string>& session_ids, bool again,
                         base::JobControl& control)
{
  return ModelRun(stages, session_ids, again, control).run();
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

void LocalStages::refine(const std::vector<std::string>& session_ids, base::JobControl& control)
{
  for (const std::string& id : session_ids)
  {
    const SessionRefinement refined = refineSessionBy(store_, id, options_.refinement, control);
    onRefined(id, refined);
    throwUnlessOk("refinement of session '" + id + "'", refined.status);
  }
}

void LocalStages::segment(const std::vector<std::string>& session_ids, base::JobControl& control)
{
  for (const std::string& id : session_ids)
  {
    const SegmentReport segmented =
        segmentStoredSession(store_, id, options_.seed_point_session, options_.segmentation, control);
    onSegmented(segmented);
    throwUnlessOk("segmentation of session '" + id + "'", segmented.status);
  }
}

AlignedSessions LocalStages::align(const std::vector<std::string>& session_ids, base::JobControl& control)
{
  const alignment::AlignmentResult aligned = alignStoredSessions(store_, session_ids, options_.align, control);
  onAligned(aligned);
  return { aligned.status, aligned.placements, leftOutOf(aligned) };
}

base::Status LocalStages::build(const AlignedSessions& aligned, base::JobControl& control)
{
  BuildOptions options = options_.build;
  options.left_out = aligned.left_out;
  const BuildReport built =
      buildObject(store_, database_, options_.object_id, options_.name, aligned.placements, options, control);
  onBuilt(built);
  return built.status;
}

}  // namespace object_modelling::pipeline
