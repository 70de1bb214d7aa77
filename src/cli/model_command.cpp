#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

#include "command.h"
#include "object_modelling/pipeline/model_object.h"
#include "object_modelling/ros_bridge/recording.h"
#include "remedy_text.h"
#include "report_text.h"
#include "temporary_store.h"

namespace object_modelling::cli
{
namespace
{
struct ModelArguments
{
  std::string object_id;
  std::vector<std::string> recordings;
  std::string database;
  std::string store;
  std::string name;
  std::vector<double> seed_point_m;
  double resolution_mm = 2;
  bool watertight = false;
  std::size_t max_triangles = 0;
  bool replace = false;
  bool require_all = false;
  bool again = false;
  double same_pose_probability = alignment::PairAlignmentOptions().same_pose_probability;
  RecordArguments record;
};

/// The stages of this process, whose reports become text and JSON.
class PrintedStages : public pipeline::LocalStages
{
public:
  PrintedStages(keyframes::SessionStore& store, database::ObjectDatabase& database,
                const pipeline::LocalStagesOptions& options, const ObjectPlace& place, CommandOutput* output)
      : LocalStages(store, database, options), place_(place), output_(output)
  {
  }

  pipeline::AlignedSessions align(const std::vector<std::string>& session_ids, base::JobControl& control) override
  {
    pipeline::AlignedSessions aligned = LocalStages::align(session_ids, control);
    if (!aligned.left_out.empty())
      aligned.status.message += "; " + remedyFor(aligned_, place_);
    return aligned;
  }

  const alignment::AlignmentResult& aligned() const { return aligned_; }
  const std::optional<pipeline::BuildReport>& built() const { return built_; }

  void onRecorded(const pipeline::RecordReport& recorded)
  {
    output_->text += "session   " + recorded.session_id + "\n" + toText(recorded);
    of(recorded.session_id) = toJson(recorded);
  }

protected:
  void onRefined(const std::string& session_id, const pipeline::SessionRefinement& refined) override
  {
    output_->text += "session   " + session_id + "\n" + toText(refined);
    of(session_id)["refinement"] = toJson(refined);
  }
  void onSegmented(const pipeline::SegmentReport& segmented) override
  {
    output_->text += "session   " + segmented.session_id + "\n" + toText(segmented);
    of(segmented.session_id)["segmentation"] = toJson(segmented);
  }
  void onAligned(const alignment::AlignmentResult& aligned) override { aligned_ = aligned; }
  void onBuilt(const pipeline::BuildReport& built) override { built_ = built; }

private:
  /// Output for a session; sessions are in the order of their first entry.
  nlohmann::json& of(const std::string& session_id)
  {
    nlohmann::json& sessions = output_->json["sessions"];
    const auto [place, is_new] = places_.emplace(session_id, sessions.size());
    if (is_new)
      sessions.push_back({ { "session_id", session_id } });
    return sessions[place->second];
  }

  ObjectPlace place_;
  CommandOutput* output_;
  std::map<std::string, std::size_t> places_;
  alignment::AlignmentResult aligned_;
  std::optional<pipeline::BuildReport> built_;
};

/// One recording becomes a stored session; its id.
std::string record(const std::string& recording, const ModelArguments& arguments, keyframes::SessionStore& store,
                   base::JobControl& control, PrintedStages* stages)
{
  const std::unique_ptr<source::FrameSource> source = ros_bridge::openRecording(recording);
  keyframes::Session session;
  session.id = sessionIdFrom(recording);
  session.object_id = arguments.object_id;
  stages->onRecorded(pipeline::recordSession(*source, session, &store, recordOptions(arguments.record), control));
  return session.id;
}

/// Before any work on the first of them: every recording needs a session id of its own.
void requireNewSessions(const std::vector<std::string>& recordings, keyframes::SessionStore& store)
{
  std::map<std::string, std::string> owner_of;
  for (const keyframes::Session& session : store.listSessions())
    owner_of[session.id] = "the store";
  for (const std::string& recording : recordings)
  {
    const auto [known, is_new] = owner_of.emplace(sessionIdFrom(recording), "'" + recording + "'");
    if (!is_new)
      throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                        "recording '" + recording + "' would become session '" + known->first + "', which " +
                            known->second +
                            " has already: sessions are named by the last part of the path, so rename the recording "
                            "or link to it by another name");
  }
}

/// Those of the object that the store has already take part.
std::vector<std::string> storedSessions(const ModelArguments& arguments, keyframes::SessionStore& store)
{
  std::vector<std::string> ids = pipeline::sessionsOf(store, arguments.object_id);
  if (ids.empty() && arguments.recordings.empty())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "store '" + arguments.store + "' has no session of object '" +
                                                              arguments.object_id + "': name a recording");
  return ids;
}

/// Says in the JSON which sessions the object does without, and why.
void tellLeftOut(const alignment::AlignmentResult& aligned, nlohmann::json* json)
{
  (*json)["partial"] = !aligned.left_out.empty();
  (*json)["left_out"] = aligned.left_out;
  (*json)["refused_pairs"] = nlohmann::json::array();
  for (const alignment::AlignmentEdge& edge : aligned.edges)
    if (!edge.reason.empty())
      (*json)["refused_pairs"].push_back(
          { { "session_a", edge.session_a }, { "session_b", edge.session_b }, { "reason", edge.reason } });
}

pipeline::LocalStagesOptions stagesOptions(const ModelArguments& arguments)
{
  pipeline::LocalStagesOptions options;
  options.object_id = arguments.object_id;
  options.name = arguments.name;
  options.refinement = refinementOptions(arguments.record);
  if (!arguments.seed_point_m.empty())
    options.seed_point_session = Eigen::Vector3d(arguments.seed_point_m.data());
  options.align.pair.same_pose_probability = arguments.same_pose_probability;
  options.align.required = arguments.require_all ? pipeline::Required::ALL : pipeline::Required::ONE;
  options.build.replace = arguments.replace;
  options.build.fusion.resolution_m = arguments.resolution_mm / 1000;
  options.build.surface.resolution_m = arguments.resolution_mm / 1000;
  options.build.surface.watertight = arguments.watertight;
  options.build.surface.max_triangles = arguments.max_triangles;
  return options;
}

/// Adds the outcome for every session. The output's status is an error where not all fit though all are required.
void tell(const pipeline::ModelOutcome& outcome, const PrintedStages& stages, const std::string& object_id,
          CommandOutput* output)
{
  const alignment::AlignmentResult& aligned = stages.aligned();
  for (const std::string& id : outcome.unchanged)
    output->text += "session   " + id + "\nas before, refined and segmented\n";
  output->json["unchanged_sessions"] = outcome.unchanged;
  tellLeftOut(aligned, &output->json);
  if (aligned.edges.size() > 0)
  {
    output->text += toText(aligned);
    output->json["alignment"] = toJson(aligned);
  }
  if (!stages.built())
  {
    output->status = { outcome.status.code, "alignment: " + outcome.status.message };
    output->json["status"] = toJson(output->status);
    return;
  }
  output->text += toText(*stages.built());
  output->json["build"] = toJson(*stages.built());
  if (!outcome.status.ok())
    throw base::Error(outcome.status.code, "building object '" + object_id + "': " + outcome.status.message);
  if (!aligned.left_out.empty())
    output->warning = outcome.status.message;
}

CommandOutput run(const ModelArguments& arguments, base::JobControl& control)
{
  if (arguments.recordings.empty() && arguments.store.empty())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "no recording: name one, or --store with sessions of '" + arguments.object_id + "'");
  // Opened first: a database that cannot be written must not cost a recording's processing.
  database::ObjectDatabase database(arguments.database, true);
  std::unique_ptr<TemporaryStore> temporary;
  std::unique_ptr<keyframes::SessionStore> opened;
  if (arguments.store.empty())
    temporary = std::make_unique<TemporaryStore>();
  else
    opened = keyframes::openSqlStore(arguments.store);
  keyframes::SessionStore& store = temporary ? temporary->get() : *opened;

  requireNewSessions(arguments.recordings, store);

  CommandOutput output;
  output.json["object_id"] = arguments.object_id;
  output.json["sessions"] = nlohmann::json::array();
  PrintedStages stages(store, database, stagesOptions(arguments),
                       { arguments.object_id, arguments.store, arguments.database }, &output);
  std::vector<std::string> session_ids = storedSessions(arguments, store);
  for (const std::string& recording : arguments.recordings)
    session_ids.push_back(record(recording, arguments, store, control, &stages));
  tell(pipeline::modelObject(stages, session_ids, arguments.again, control), stages, arguments.object_id, &output);
  return output;
}
}  // namespace

void addModelCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<ModelArguments>();
  CLI::App* command = app.add_subcommand("model", "Object model from recordings, one session each");
  command->add_option("object_id", arguments->object_id, "Name of the object in the database (letters, digits, _ . -)")
      ->required();
  command->add_option("recordings", arguments->recordings,
                      "TUM-style folders or ROS bags; none with --store: build from the sessions that it has");
  command->add_option("--database", arguments->database, "Folder of the object database; made if missing")->required();
  command->add_option(
      "--store", arguments->store,
      "Keep the sessions in this keyframe store (SQLite file), and build from those of the object that it has "
      "too; without it they are not kept");
  command->add_option("--name", arguments->name, "Name for people");
  command
      ->add_option(
          "--seed-point", arguments->seed_point_m,
          "x y z (m) of a point on the object, in the optical frame of the first keyframe; without it the object "
          "is chosen automatically")
      ->expected(3);
  command->add_option("--resolution", arguments->resolution_mm, "Spacing of model points in mm")
      ->check(CLI::Range(0.2, 50.0))
      ->capture_default_str();
  command->add_flag("--watertight", arguments->watertight, "Close the mesh; what no camera saw is marked");
  command->add_option("--max-triangles", arguments->max_triangles,
                      "Budget of triangles of the mesh; without it the resolution decides");
  command->add_flag(
      "--replace", arguments->replace,
      "Replace an object of this name that was built from other sessions, even where its frame cannot be kept: "
      "where it is not certain how the new model lies to the old one, a new frame begins");
  addRecordOptions(*command, &arguments->record);
  command
      ->add_option("--same-pose-probability", arguments->same_pose_probability,
                   "How often the object is recorded again without having been turned over; 0.5: as often as not")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_flag(
      "--require-all", arguments->require_all,
      "Fail where not all sessions fit each other, instead of building a partial object from those that do");
  command->add_flag("--again", arguments->again,
                    "Refine and segment anew the sessions of the store that were refined and segmented before");
  command->footer("Example: object_modelling model mustard recordings/mustard_up --database ~/objects");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
