#include <filesystem>
#include <iomanip>
#include <memory>
#include <sstream>

#include "command.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/pipeline/merge_objects.h"
#include "report_text.h"

namespace object_modelling::cli
{
namespace
{
struct IdentityArguments
{
  std::string database, object_id, other_id, store;
  double resolution_mm = 2;
};

/// None without a name. Opening a store makes it where there is none: a mistyped name must not.
std::unique_ptr<keyframes::SessionStore> storeNamed(const std::string& connection)
{
  if (connection.empty())
    return nullptr;
  if (connection.rfind("postgresql://", 0) != 0 && !std::filesystem::exists(connection))
    throw base::Error(base::StatusCode::NOT_FOUND, "no keyframe store at '" + connection + "'");
  return keyframes::openSqlStore(connection);
}

bool exportHolds(const std::filesystem::path& folder, const std::string& object_id)
{
  if (std::filesystem::exists(folder / object_id))
    return true;
  const std::filesystem::path marker = folder / "export.yaml";  // of a folder that all objects share
  return std::filesystem::exists(marker) &&
         base::readTextFile(marker.string()).find(" " + object_id + ":") != std::string::npos;
}

/// How the exports in the database that hold the object are made anew; empty where none does.
std::string exportsRemedy(const std::string& database_root, const std::string& object_id)
{
  std::string commands;
  const std::filesystem::path exports = database_root + "/exports";
  if (std::filesystem::is_directory(exports))
    for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(exports))
      if (entry.is_directory() && exportHolds(entry.path(), object_id))
        commands += (commands.empty() ? "'" : ", '") + std::string("object_modelling export ") + database_root +
                    " --format " + entry.path().filename().string() + "'";
  return commands.empty() ? commands : "exports still hold '" + object_id + "': make them anew by " + commands;
}

/// What is left to do beside the database.
void addRemedies(const IdentityArguments& arguments, const std::string& former_id, const std::string& id,
                 CommandOutput* output)
{
  const auto add = [&](const std::string& text)
  { output->warning += (output->warning.empty() || text.empty() ? "" : "; ") + text; };
  add(exportsRemedy(std::filesystem::absolute(arguments.database).lexically_normal().string(), former_id));
  if (arguments.store.empty())
    output->text +=
        "sessions of '" + former_id + "' in a keyframe store keep that name; --store gives them '" + id + "', too\n";
}

CommandOutput rename(const IdentityArguments& arguments, base::JobControl& control)
{
  database::ObjectDatabase database(arguments.database, false);
  const std::unique_ptr<keyframes::SessionStore> store = storeNamed(arguments.store);
  CommandOutput output;
  output.warning = pipeline::renameObject(database, arguments.object_id, arguments.other_id, store.get(), control);
  output.text = arguments.object_id + " is now " + arguments.other_id + "\n";
  output.json = { { "object_id", arguments.other_id }, { "renamed_from", arguments.object_id } };
  addRemedies(arguments, arguments.object_id, arguments.other_id, &output);
  return output;
}

CommandOutput merge(const IdentityArguments& arguments, base::JobControl& control)
{
  database::ObjectDatabase database(arguments.database, false);
  const std::unique_ptr<keyframes::SessionStore> store = storeNamed(arguments.store);
  pipeline::BuildOptions options;
  options.fusion.resolution_m = options.surface.resolution_m = arguments.resolution_mm / 1000;
  const pipeline::MergeReport report =
      pipeline::mergeObjects(database, arguments.object_id, arguments.other_id, options, store.get(), control);
  if (!report.status.ok())
    throw base::Error(report.status.code, report.status.message);
  CommandOutput output;
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "merged    " << arguments.other_id << " into " << arguments.object_id
       << " (probability " << report.probability << "), whose frame stays; '" << arguments.other_id
       << "' is an alias of it\n";
  output.text = text.str() + (report.rebuilt ? toText(report.built) : "          its model stays as it was\n");
  output.json = { { "object_id", arguments.object_id },
                  { "merged", arguments.other_id },
                  { "probability", report.probability },
                  { "rebuilt", report.rebuilt } };
  if (report.rebuilt)
    output.json["build"] = toJson(report.built);
  else
    output.warning = report.status.message;
  addRemedies(arguments, arguments.other_id, arguments.object_id, &output);
  return output;
}

CLI::App* addIdentityCommand(CLI::App& app, const std::string& name, const std::string& help,
                             const std::shared_ptr<IdentityArguments>& arguments)
{
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("database", arguments->database, "Folder of the object database")->required();
  command->add_option("--store", arguments->store,
                      "Keyframe store (SQLite file or postgresql://...) whose sessions follow");
  return command;
}
}  // namespace

void addIdentityCommands(CLI::App& app, Command* chosen)
{
  const auto renamed = std::make_shared<IdentityArguments>();
  CLI::App* command = addIdentityCommand(app, "rename", "Give an object of a database another id", renamed);
  command->add_option("object_id", renamed->object_id, "The object's id")->required();
  command->add_option("new_id", renamed->other_id, "The id it gets")->required();
  command->footer(
      "Its report is made anew, too. Example: object_modelling rename ~/objects mug cup --store sessions.sqlite");
  command->callback([=] { *chosen = [=](base::JobControl& control) { return rename(*renamed, control); }; });

  const auto merged = std::make_shared<IdentityArguments>();
  command = addIdentityCommand(app, "merge", "Make one object of two that are the same", merged);
  command->add_option("keep", merged->object_id, "The object whose id and frame stay")->required();
  command->add_option("drop", merged->other_id, "The object that goes into it; its id becomes an alias")->required();
  command->add_option("--resolution", merged->resolution_mm, "Spacing of model points in mm")
      ->check(CLI::Range(0.2, 50.0))
      ->capture_default_str();
  command->footer(
      "The common model is made of the views of both in the database. Refused where it is not certain that both are "
      "one.\nExample: object_modelling merge ~/objects mug mug_2");
  command->callback([=] { *chosen = [=](base::JobControl& control) { return merge(*merged, control); }; });
}

}  // namespace object_modelling::cli
