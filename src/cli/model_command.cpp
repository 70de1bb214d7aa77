#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

#include "command.h"
#include "object_modelling/pipeline/align_sessions.h"
#include "object_modelling/pipeline/build_object.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/ros_bridge/recording.h"
#include "remedy_text.h"
#include "report_text.h"
#include "temporary_store.h"

namespace object_modelling::cli
{
namespace
{
struct Arguments
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
  double same_pose_probability = alignment::PairAlignmentOptions().same_pose_probability;
  RecordArguments record;
};

void throwUnlessOk(const std::string& stage, const base::Status& status)
{
  if (!status.ok())
    throw base::Error(status.code, stage + ": " + status.message);
}

/// One recording through tracking, refinement and segmentation; text and JSON are appended to the output.
std::string processRecording(const std::string& recording, const Arguments& arguments, keyframes::SessionStore& store,
                             base::JobControl& control, CommandOutput* output)
{
  const std::unique_ptr<source::FrameSource> source = ros_bridge::openRecording(recording);
  keyframes::Session session;
  session.id = sessionIdFrom(recording);
  session.object_id = arguments.object_id;
  const pipeline::RecordReport recorded =
      pipeline::recordSession(*source, session, &store, recordOptions(arguments.record), control);
  output->text += "session   " + session.id + "\n" + toText(recorded);
  nlohmann::json json = toJson(recorded);

  const pipeline::SessionRefinement refined =
      pipeline::refineSessionBy(store, session.id, refinementOptions(arguments.record), control);
  output->text += toText(refined);
  json["refinement"] = toJson(refined);
  throwUnlessOk("refinement of session '" + session.id + "'", refined.status);

  std::optional<Eigen::Vector3d> seed_point_session;
  if (!arguments.seed_point_m.empty())
    seed_point_session = Eigen::Vector3d(arguments.seed_point_m.data());
  const pipeline::SegmentReport segmented =
      pipeline::segmentSession(store, session.id, seed_point_session, {}, control);
  output->text += toText(segmented);
  json["segmentation"] = toJson(segmented);
  throwUnlessOk("segmentation of session '" + session.id + "'", segmented.status);
  output->json["sessions"].push_back(std::move(json));
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
std::vector<std::string> storedSessions(const Arguments& arguments, keyframes::SessionStore& store)
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

/// Where not all fit though they are required to, the output's status says so.
alignment::AlignmentResult align(const Arguments& arguments, const std::vector<std::string>& session_ids,
                                 keyframes::SessionStore& store, base::JobControl& control, CommandOutput* output)
{
  pipeline::AlignOptions options;
  options.pair.same_pose_probability = arguments.same_pose_probability;
  options.required = arguments.require_all ? pipeline::Required::ALL : pipeline::Required::ONE;
  alignment::AlignmentResult aligned = pipeline::alignSessions(store, session_ids, options, control);
  if (aligned.left_out.empty())
    throwUnlessOk("alignment", aligned.status);
  else
    aligned.status.message += "; " + remedyFor(aligned, { arguments.object_id, arguments.store, arguments.database });
  tellLeftOut(aligned, &output->json);
  if (session_ids.size() > 1)
  {
    output->text += toText(aligned);
    output->json["alignment"] = toJson(aligned);
  }
  if (!aligned.status.ok())
  {
    output->status = { aligned.status.code, "alignment: " + aligned.status.message };
    output->json["status"] = toJson(output->status);
  }
  return aligned;
}

void build(const Arguments& arguments, const alignment::AlignmentResult& aligned, keyframes::SessionStore& store,
           database::ObjectDatabase& database, base::JobControl& control, CommandOutput* output)
{
  pipeline::BuildOptions options;
  options.replace = arguments.replace;
  options.fusion.resolution_m = arguments.resolution_mm / 1000;
  options.surface.resolution_m = arguments.resolution_mm / 1000;
  options.surface.watertight = arguments.watertight;
  options.surface.max_triangles = arguments.max_triangles;
  options.left_out = pipeline::leftOutOf(aligned);
  const pipeline::BuildReport built =
      pipeline::buildObject(store, database, arguments.object_id, arguments.name, aligned.placements, options, control);
  output->text += toText(built);
  output->json["build"] = toJson(built);
  base::Status status = built.status;
  if (!aligned.left_out.empty())
    status.message += "; " + aligned.status.message;
  throwUnlessOk("building object '" + arguments.object_id + "'", status);
  if (!aligned.left_out.empty())
    output->warning = status.message;
}

CommandOutput run(const Arguments& arguments, base::JobControl& control)
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
  std::vector<std::string> session_ids = storedSessions(arguments, store);
  for (const std::string& recording : arguments.recordings)
    session_ids.push_back(processRecording(recording, arguments, store, control, &output));

  const alignment::AlignmentResult aligned = align(arguments, session_ids, store, control, &output);
  if (!output.status.ok())
    return output;
  build(arguments, aligned, store, database, control, &output);
  return output;
}
}  // namespace

void addModelCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<Arguments>();
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
  command->add_flag("--replace", arguments->replace,
                    "Replace an object of this name that was built from other sessions; its frame changes");
  addRecordOptions(*command, &arguments->record);
  command
      ->add_option("--same-pose-probability", arguments->same_pose_probability,
                   "How often the object is recorded again without having been turned over; 0.5: as often as not")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_flag(
      "--require-all", arguments->require_all,
      "Fail where not all sessions fit each other, instead of building a partial object from those that do");
  command->footer("Example: object_modelling model mustard recordings/mustard_up --database ~/objects");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
