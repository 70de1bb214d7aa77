#include "build_services.h"

#include "../jobs/session_list.h"
#include "action_stages.h"
#include "object_modelling/ros_bridge/timed_call.h"
#include "service_answer.h"
#include "session_choice.h"

namespace object_modelling::nodes
{
namespace
{
using Lock = std::lock_guard<std::mutex>;

object_modelling::StageTime timeMessage(const pipeline::StageTime& time)
{
  object_modelling::StageTime message;
  message.stage = time.stage;
  message.duration_s = time.duration_s;
  return message;
}

/// All stages in their order: those of the builder singly, in place of the last one.
void addTimes(std::vector<pipeline::StageTime> times, object_modelling::BuiltObject* built)
{
  times.pop_back();
  std::vector<object_modelling::StageTime> all;
  for (const pipeline::StageTime& time : times)
    all.push_back(timeMessage(time));
  built->stages.insert(built->stages.begin(), all.begin(), all.end());
}
}  // namespace

BuildServices::BuildServices(ros::NodeHandle& node, ros::NodeHandle& private_node, ros::NodeHandle& slow_node,
                             const ManagerOptions& options, keyframes::SessionStore& store, ManagerBoard& board)
    : node_(node), options_(options), store_(store), board_(board), jobs_(node, options)
{
  servers_ = { serve<Build>(slow_node, "build_object", this, &BuildServices::build),
               serve<object_modelling::ListObjects>(slow_node, "list_objects", this, &BuildServices::listObjects),
               serve<object_modelling::Cancel>(private_node, "cancel", this, &BuildServices::cancel) };
}

BuildServices::~BuildServices()
{
  close();
  servers_.clear();  // waits for callbacks
  if (thread_.joinable())
    thread_.join();
}

void BuildServices::close()
{
  const Lock lock(board_.mutex);
  closed_ = true;
  if (control_)
    control_->cancel();
}

std::string BuildServices::begin(const std::string& object_id)
{
  const Lock one_at_a_time(board_.commands);
  const Lock lock(board_.mutex);
  if (closed_)
    throw base::Error(base::StatusCode::CANCELLED, "the node is being shut down");
  const std::string last_session_id = board_.state.sessionId();
  board_.state.beginBuild(object_id);
  control_ = std::make_unique<base::JobControl>([this](const base::Progress& progress) { onProgress(progress); });
  board_.succeeded();
  return last_session_id;
}

void BuildServices::build(const Build::Request& request, Build::Response& response)
{
  checkId("object id", request.object_id);
  const std::string last_session_id = begin(request.object_id);
  std::future<Outcome> outcome;
  try
  {
    const std::vector<std::string> session_ids =
        chooseSessions(store_, request.object_id, request.session_ids, last_session_id);
    std::packaged_task<Outcome()> work([this, request, session_ids] { return run(request, session_ids); });
    outcome = work.get_future();
    // The last build has ended, or the state would still be BUILDING; and this one cannot end before it is kept.
    const Lock lock(board_.mutex);
    if (thread_.joinable())
      thread_.join();
    thread_ = std::thread(std::move(work));
  }
  catch (...)
  {
    end(request.object_id, nullptr);
    throw;
  }
  if (!request.wait)
    return;
  const Outcome ended = outcome.get();
  if (!ended.status.ok())
    throw base::Error(ended.status.code, ended.status.message);
  response.status = ros_bridge::toMessage(ended.status);
  response.built = ended.built;
}

BuildServices::Outcome BuildServices::run(const Build::Request& request, const std::vector<std::string>& session_ids)
{
  ROS_INFO("building '%s' from %s", request.object_id.c_str(), joined(session_ids).c_str());
  Outcome outcome;
  const base::Status thrown = ros_bridge::guarded([&] { outcome = runStages(request, session_ids); });
  if (!thrown.ok())
    outcome.status = thrown;
  else if (outcome.status.ok() && !outcome.status.message.empty())
    ROS_WARN("'%s' is built, but: %s", request.object_id.c_str(), outcome.status.message.c_str());
  end(request.object_id, &outcome);
  return outcome;
}

BuildServices::Outcome BuildServices::runStages(const Build::Request& request,
                                                const std::vector<std::string>& session_ids)
{
  ActionStages stages(jobs_, store_, request, [&](const std::string& stage) { enterStage(request.object_id, stage); });
  try
  {
    const pipeline::ModelOutcome made = pipeline::modelObject(stages, session_ids, request.again, *control_);
    Outcome outcome{ made.status, stages.built() };
    if (made.built)
      addTimes(made.stages, &outcome.built);
    return outcome;
  }
  catch (const base::Cancelled& cancelled)
  {
    const Lock lock(board_.mutex);
    throw base::Error(cancelled.code(), "cancelled on request in stage '" + board_.state.stage() + "'");
  }
}

void BuildServices::enterStage(const std::string& object_id, const std::string& stage)
{
  {
    const Lock lock(board_.mutex);
    board_.state.enterStage(stage);
    board_.publishState();
  }
  board_.progress(object_id, { stage, 0, 0 });
}

void BuildServices::onProgress(const base::Progress& step)
{
  base::Progress progress = step;
  std::string object_id;
  {
    const Lock lock(board_.mutex);
    progress.stage = board_.state.stage() + (step.stage.empty() ? "" : ": " + step.stage);
    object_id = board_.state.objectId();
  }
  board_.progress(object_id, progress);
}

void BuildServices::end(const std::string& object_id, const Outcome* outcome)
{
  const Lock lock(board_.mutex);
  board_.state.endBuild();
  control_.reset();
  if (outcome == nullptr)
    return board_.publishState();
  board_.finished(object_id, outcome->status);
  if (!outcome->status.ok())
    return board_.failed(outcome->status);
  board_.setBuilt(outcome->built);
  board_.succeeded(outcome->status.message);
}

void BuildServices::listObjects(const object_modelling::ListObjects::Request&,
                                object_modelling::ListObjects::Response& response)
{
  object_modelling::ListObjects service;
  ros_bridge::callInTime(node_, "model_builder/list_objects", { options_.service_wait_s, options_.call_timeout_s },
                         service);
  response = service.response;
}

void BuildServices::cancel(const object_modelling::Cancel::Request&, object_modelling::Cancel::Response& response)
{
  const Lock lock(board_.mutex);
  board_.state.checkCanCancel();
  control_->cancel();
  response.object_id = board_.state.objectId();
}

}  // namespace object_modelling::nodes
