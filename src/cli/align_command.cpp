#include <algorithm>
#include <filesystem>
#include <memory>

#include "command.h"
#include "object_modelling/pipeline/align_sessions.h"
#include "remedy_text.h"
#include "report_text.h"

namespace object_modelling::cli
{
namespace
{
struct AlignArguments
{
  std::string object_id, store;
  std::vector<std::string> session_ids;
  pipeline::AlignOptions options;
  bool gray = false, anew = false;
  std::vector<std::string> accept, refuse, forget;  ///< two sessions each, or none
  std::size_t candidate = 0;
};

/// A file that is not there is a mistyped name: opening it would make an empty store.
void requireStore(const std::string& connection)
{
  if (connection.rfind("postgresql://", 0) != 0 && !std::filesystem::exists(connection))
    throw base::Error(base::StatusCode::NOT_FOUND, "no keyframe store at '" + connection + "'");
}

/// What a person decided comes first.
void decide(const AlignArguments& arguments, keyframes::SessionStore& store)
{
  if (!arguments.forget.empty())
    pipeline::forgetAlignment(store, arguments.forget[0], arguments.forget[1]);
  if (!arguments.refuse.empty())
    pipeline::refuseAlignment(store, arguments.refuse[0], arguments.refuse[1]);
  if (!arguments.accept.empty())
    pipeline::acceptAlignment(store, arguments.accept[0], arguments.accept[1], arguments.candidate);
}

CommandOutput run(const AlignArguments& arguments, base::JobControl& control)
{
  requireStore(arguments.store);
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(arguments.store);
  std::vector<std::string> ids = arguments.session_ids;
  if (ids.empty())
    ids = pipeline::sessionsOf(*store, arguments.object_id);
  if (ids.empty())
    throw base::Error(base::StatusCode::NOT_FOUND, "store '" + arguments.store + "' has no session of object '" +
                                                       arguments.object_id +
                                                       "': record one with this object id, or name --session");
  pipeline::AlignOptions options = arguments.options;
  options.part.use_color = !arguments.gray;
  options.use_known = !arguments.anew;
  decide(arguments, *store);
  alignment::AlignmentResult aligned = pipeline::alignStoredSessions(*store, ids, options, control);
  if (!aligned.left_out.empty())
    aligned.status.message += "; " + remedyFor(aligned, { arguments.object_id, arguments.store, "" });
  CommandOutput output;
  output.status = aligned.status;
  const bool note = aligned.status.ok() && !aligned.status.message.empty();
  output.text = toText(aligned) + (note ? "note      " + aligned.status.message + "\n" : "");
  output.json = toJson(aligned);
  output.json["object_id"] = arguments.object_id;
  return output;
}
}  // namespace

void addAlignCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<AlignArguments>();
  CLI::App* command = app.add_subcommand(
      "align", "Relative poses of an object's sessions, recorded in different resting poses; kept in the store");
  command->add_option("object_id", arguments->object_id, "Object whose sessions are aligned")->required();
  command->add_option("--store", arguments->store, "Keyframe store with segmented sessions")->required();
  command->add_option("--session", arguments->session_ids, "Align these sessions instead of all of the object");
  command->add_flag("--grey", arguments->gray, "By the shape alone, without colour and features");
  command->add_option("--rotations", arguments->options.pair.rotations, "Rotations tried, evenly over all")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_option("--min-overlap", arguments->options.pair.min_overlap_ratio, "Least share of surface in common")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--same-pose-probability", arguments->options.pair.same_pose_probability,
                   "How often an object is recorded again without being turned over; 0.5: as often as not")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.pair.seed, "Of the random samples")->capture_default_str();
  command->add_flag("--anew", arguments->anew, "Search every pair again, but for those that a person decided");
  CLI::Option* accept =
      command->add_option("--accept", arguments->accept, "Two sessions: their candidate is right, whatever its figures")
          ->expected(2);
  command->add_option("--candidate", arguments->candidate, "Which one --accept means, 0 the best")
      ->needs(accept)
      ->capture_default_str();
  command->add_option("--refuse", arguments->refuse, "Two sessions that are not to be joined")->expected(2);
  command->add_option("--forget", arguments->forget, "Two sessions: forget what was decided on them")->expected(2);
  command->footer("Example: object_modelling align mustard --store sessions.sqlite --json");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
