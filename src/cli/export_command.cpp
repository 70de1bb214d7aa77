#include <memory>

#include "command.h"
#include "object_modelling/report/python_program.h"

namespace object_modelling::cli
{
namespace
{
constexpr char PROGRAM[] = "export_objects";
constexpr std::chrono::hours TIMEOUT{ 6 };
constexpr int FIRST_STATUS_EXIT_CODE = 10;  ///< with OK; the others follow in the order of StatusCode

struct ExportArguments
{
  std::string database, format, folder, unit;
  std::vector<std::string> object_ids;
};

base::StatusCode statusFrom(int exit_code)
{
  const int code = exit_code - FIRST_STATUS_EXIT_CODE;
  const bool known =
      code > static_cast<int>(base::StatusCode::OK) && code < static_cast<int>(base::StatusCode::INTERNAL);
  return known ? static_cast<base::StatusCode>(code) : base::StatusCode::INTERNAL;
}

CommandOutput run(const ExportArguments& arguments, base::JobControl& control)
{
  std::vector<std::string> words = { arguments.database, "--format=" + arguments.format, "--json" };
  if (!arguments.folder.empty())
    words.push_back("--out=" + arguments.folder);
  if (!arguments.unit.empty())
    words.push_back("--unit=" + arguments.unit);
  for (const std::string& object_id : arguments.object_ids)
    words.push_back("--id=" + object_id);
  control.report("export", 0, 1);
  const report::ProgramResult result = report::runPythonProgram(PROGRAM, words, TIMEOUT, control);
  const std::string prefix = std::string(PROGRAM) + ": ";
  const bool own_words = result.last_error_line.rfind(prefix, 0) == 0;
  if (result.exit_code != 0)
    throw base::Error(statusFrom(result.exit_code),
                      own_words ? result.last_error_line.substr(prefix.size()) : prefix + result.last_error_line);
  control.report("export", 1, 1);
  const nlohmann::json answer = nlohmann::json::parse(result.output);
  return { answer.at("text").get<std::string>(), answer, {}, answer.value("warning", "") };
}
}  // namespace

void addExportCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Write objects of a database as files for other programs");
  command->add_option("database", arguments->database, "Folder of the object database")->required();
  command->add_option("--format", arguments->format, "Format; 'list' names all of them")->required();
  command->add_option("--id", arguments->object_ids, "Name of an object in the database; all of them without it");
  command->add_option("--out", arguments->folder, "Folder to write to; DATABASE/exports/FORMAT without it");
  command->add_option("--unit", arguments->unit, "Unit of mesh formats, 'm' (default) or 'mm'")
      ->check(CLI::IsMember({ "m", "mm" }));
  command->footer("Example: object_modelling export ~/objects --format urdf --id mustard\nFormats: docs/exports.md");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
