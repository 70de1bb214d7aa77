#include <iomanip>
#include <memory>
#include <sstream>

#include "command.h"
#include "object_modelling/pipeline/import_mesh.h"

namespace object_modelling::cli
{
namespace
{
struct ImportMeshArguments
{
  std::string mesh, object_id, name, unit, database;
  double mass_kg = 0;
  bool replace = false;
};

CommandOutput run(const ImportMeshArguments& arguments, base::JobControl& control)
{
  pipeline::ImportOptions options;
  options.unit_m = arguments.unit.empty() ? 0 : arguments.unit == "mm" ? 0.001 : 1;
  options.replace = arguments.replace;
  options.properties.mass.mass_kg = arguments.mass_kg;
  database::ObjectDatabase database(arguments.database, true);
  const pipeline::ImportReport report =
      pipeline::importMesh(arguments.mesh, arguments.object_id, arguments.name, database, options, control);
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "imported  " << 1000 * report.size_m.x() << " x "
       << 1000 * report.size_m.y() << " x " << 1000 * report.size_m.z() << " mm (the file's unit is "
       << (report.unit_m == 1 ? "m" : "mm") << ")\n          " << report.properties << "\n          "
       << report.object_folder << "\n";
  return { text.str(),
           { { "object_id", arguments.object_id },
             { "object_folder", report.object_folder },
             { "unit_m", report.unit_m },
             { "size_m", { report.size_m.x(), report.size_m.y(), report.size_m.z() } },
             { "properties", report.properties } } };
}
}  // namespace

void addImportMeshCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<ImportMeshArguments>();
  CLI::App* command =
      app.add_subcommand("import_mesh", "Make an object of a mesh file (CAD, scan), with rendered views");
  command->add_option("mesh", arguments->mesh, "OBJ, PLY, STL or GLB file")->required();
  command->add_option("database", arguments->database, "Folder of the object database; made if missing")->required();
  command->add_option("--id", arguments->object_id, "Name of the object in the database")->required();
  command->add_option("--name", arguments->name, "Name for people; the id if left out");
  command->add_option("--unit", arguments->unit, "Unit of the file; found by the mesh's size if left out")
      ->check(CLI::IsMember({ "mm", "m" }));
  command->add_option("--mass-kg", arguments->mass_kg, "As weighed; a density is assumed if left out")
      ->check(CLI::PositiveNumber);
  command->add_flag("--replace", arguments->replace, "Replace an object of this id");
  command->footer("Example: object_modelling import_mesh bracket.stl ~/objects --id bracket --unit mm");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
