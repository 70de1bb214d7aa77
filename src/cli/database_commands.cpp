#include <memory>

#include "command.h"
#include "object_modelling/database/object_database.h"

namespace object_modelling::cli
{
namespace
{
using database::ObjectDatabase;

CommandOutput check(const std::string& path)
{
  const ObjectDatabase database(path, false);
  const std::vector<std::string> problems = database.check();
  CommandOutput output;
  output.json = { { "problems", problems } };
  for (const std::string& problem : problems)
    output.text += "PROBLEM " + problem + "\n";
  output.text +=
      std::to_string(database.list().size()) + " object(s), " + std::to_string(problems.size()) + " problem(s)\n";
  if (!problems.empty())
    output.status = { base::StatusCode::BAD_INPUT, "object database " + database.root() + " has " +
                                                       std::to_string(problems.size()) + " problem(s), named above" };
  return output;
}

CommandOutput migrate(const std::string& path, base::JobControl& control)
{
  ObjectDatabase database(path, false);
  CommandOutput output;
  output.json = { { "migrated", nlohmann::json::array() }, { "up_to_date", nlohmann::json::array() } };
  for (const database::ObjectEntry& entry : database.list())
  {
    const bool changed = database.migrate(entry.id, control);
    output.json[changed ? "migrated" : "up_to_date"].push_back(entry.id);
    output.text += entry.id +
                   (changed ? ": migrated from schema version " + std::to_string(entry.schema_version)
                            : std::string(": up to date")) +
                   "\n";
  }
  return output;
}

CommandOutput remove(const std::string& path, const std::string& object_id)
{
  ObjectDatabase database(path, false);
  database.remove(object_id);
  return { object_id + " is deleted\n", { { "deleted", object_id } } };
}

struct DatabaseArguments
{
  std::string database, object_id;
};

CLI::App* addCommand(CLI::App& app, const std::string& name, const std::string& help,
                     const std::shared_ptr<DatabaseArguments>& arguments)
{
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("database", arguments->database, "Folder of the object database")->required();
  return command;
}
}  // namespace

void addDatabaseCommands(CLI::App& app, Command* chosen)
{
  const auto arguments = std::make_shared<DatabaseArguments>();
  CLI::App* command = addCommand(app, "check", "Whether an object database is sound; names every fault", arguments);
  command->footer("Exit code 0 if it is. Example: object_modelling check ~/objects");
  command->callback([=] { *chosen = [=](base::JobControl&) { return check(arguments->database); }; });

  command = addCommand(app, "migrate", "Bring the objects of an older database to the present schema", arguments);
  command->footer("Adds properties of the meshes; all else stays. Example: object_modelling migrate ~/objects");
  command->callback([=]
                    { *chosen = [=](base::JobControl& control) { return migrate(arguments->database, control); }; });

  command = addCommand(app, "delete", "Take an object out of a database, with all its files", arguments);
  command->add_option("object_id", arguments->object_id, "The object's id")->required();
  command->footer("Its sessions stay in their store. Example: object_modelling delete ~/objects mug");
  command->callback(
      [=] { *chosen = [=](base::JobControl&) { return remove(arguments->database, arguments->object_id); }; });
}

}  // namespace object_modelling::cli
