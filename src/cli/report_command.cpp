#include <memory>

#include "command.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/report/report_maker.h"

namespace object_modelling::cli
{
namespace
{
struct ReportArguments
{
  std::string object_id, database;
};

CommandOutput run(const ReportArguments& arguments, base::JobControl& control)
{
  database::ObjectDatabase database(arguments.database, false);
  control.report("report", 0, 1);
  database.remakeReport(arguments.object_id, control,
                        [&](const std::string& folder) { report::makeReport(folder, control); });
  control.report("report", 1, 1);
  const std::string path = database.root() + "/" + arguments.object_id + "/report.html";
  return { path + "\n", { { "object_id", arguments.object_id }, { "report_path", path } } };
}
}  // namespace

void addReportCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "Make the report.html of an object in a database anew");
  command->add_option("object_id", arguments->object_id, "Name of the object in the database")->required();
  command->add_option("--database", arguments->database, "Folder of the object database")->required();
  command->footer("Example: object_modelling report mustard --database ~/objects");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
