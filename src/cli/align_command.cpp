#include <algorithm>
#include <filesystem>
#include <memory>

#include "command.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "report_text.h"

namespace object_modelling::cli
{
namespace
{
struct Arguments
{
  std::string object_id, store;
  std::vector<std::string> session_ids;
  pipeline::AlignOptions options;
  bool grey = false;
};

/// A file that is not there is a mistyped name: opening it would make an empty store.
void requireStore(const std::string& connection)
{
  if (connection.rfind("postgresql://", 0) != 0 && !std::filesystem::exists(connection))
    throw base::Error(base::StatusCode::NOT_FOUND, "no keyframe store at '" + connection + "'");
}

std::vector<std::string> sessionsOf(const std::string& object_id, keyframes::SessionStore& store)
{
  std::vector<std::string> ids;
  for (const keyframes::Session& session : store.listSessions())
    if (session.object_id == object_id)
      ids.push_back(session.id);
  return ids;
}

CommandOutput run(const Arguments& arguments, base::JobControl& control)
{
  requireStore(arguments.store);
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(arguments.store);
  std::vector<std::string> ids = arguments.session_ids;
  if (ids.empty())
    ids = sessionsOf(arguments.object_id, *store);
  if (ids.empty())
    throw base::Error(base::StatusCode::NOT_FOUND, "store '" + arguments.store + "' has no session of object '" +
                                                       arguments.object_id +
                                                       "': record one with this object id, or name --session");
  pipeline::AlignOptions options = arguments.options;
  options.part.use_color = !arguments.grey;
  const alignment::AlignmentResult aligned = pipeline::alignSessions(*store, ids, options, control);
  if (!aligned.status.ok())
    throw base::Error(aligned.status.code, aligned.status.message);
  CommandOutput output;
  output.text = toText(aligned) + (aligned.status.message.empty() ? "" : "note      " + aligned.status.message + "\n");
  output.json = toJson(aligned);
  output.json["object_id"] = arguments.object_id;
  return output;
}
}  // namespace

void addAlignCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "align", "Relative poses of an object's sessions, recorded in different resting poses; writes nothing");
  command->add_option("object_id", arguments->object_id, "Object whose sessions are aligned")->required();
  command->add_option("--store", arguments->store, "Keyframe store with segmented sessions")->required();
  command->add_option("--session", arguments->session_ids, "Align these sessions instead of all of the object");
  command->add_flag("--grey", arguments->grey, "By the shape alone, without colour and features");
  command->add_option("--rotations", arguments->options.pair.rotations, "Rotations tried, evenly over all")
      ->capture_default_str();
  command->add_option("--min-overlap", arguments->options.pair.min_overlap_ratio, "Least share of surface in common")
      ->capture_default_str();
  command->add_option("--seed", arguments->options.pair.seed, "Of the random samples")->capture_default_str();
  command->footer("Example: object_modelling align mustard --store sessions.sqlite --json");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
