#include <filesystem>
#include <iomanip>
#include <memory>
#include <sstream>

#include "command.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::cli
{
namespace
{
CommandOutput describeDatabase(const std::string& path)
{
  const database::ObjectDatabase database(path, false);
  CommandOutput output;
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  output.json["objects"] = nlohmann::json::array();
  for (const database::ObjectEntry& entry : database.list())
  {
    nlohmann::json sessions = nlohmann::json::array();
    for (const database::ModelSession& session : entry.sessions)
      sessions.push_back(session.id);
    nlohmann::json left_out = nlohmann::json::array();
    for (const database::LeftOutSession& session : entry.sessions_left_out)
      left_out.push_back({ { "session_id", session.id }, { "reason", session.reason } });
    output.json["objects"].push_back({ { "id", entry.id },
                                       { "name", entry.name },
                                       { "size_m", { entry.size_m.x(), entry.size_m.y(), entry.size_m.z() } },
                                       { "diameter_m", entry.diameter_m },
                                       { "sessions", sessions },
                                       { "partial", entry.partial },
                                       { "frame_version", entry.frame_version },
                                       { "aliases", entry.aliases },
                                       { "sessions_left_out", left_out },
                                       { "quality", entry.quality },
                                       { "mesh_path", entry.mesh_path },
                                       { "content_hash", entry.content_hash } });
    text << entry.id << ": " << 1000 * entry.size_m.x() << " x " << 1000 * entry.size_m.y() << " x "
         << 1000 * entry.size_m.z() << " mm, " << entry.sessions.size() << " session(s)"
         << (entry.partial ? ", PARTIAL: " + std::to_string(left_out.size()) + " left out" : "") << "\n";
    if (entry.properties)
      text << "  " << object_properties::summaryText(*entry.properties, entry.collision_paths.size()) << "\n";
    if (entry.frame_version > 1)
      text << "  version " << entry.frame_version
           << " of its frame: what was annotated in an older one does not hold\n";
    for (const std::string& alias : entry.aliases)
      text << "  also known as " << alias << "\n";
    for (const database::LeftOutSession& session : entry.sessions_left_out)
      text << "  without " << session.id << ": " << session.reason << "\n";
  }
  text << output.json["objects"].size() << " object(s); whether they are sound tells 'object_modelling check'\n";
  output.text = text.str();
  return output;
}

CommandOutput describeStore(const std::string& path)
{
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(path);
  CommandOutput output;
  std::ostringstream text;
  output.json["sessions"] = nlohmann::json::array();
  for (const keyframes::Session& session : store->listSessions())
  {
    output.json["sessions"].push_back({ { "id", session.id },
                                        { "object_id", session.object_id },
                                        { "keyframe_count", session.keyframe_count },
                                        { "closed", session.closed },
                                        { "started_s", session.started_s } });
    text << session.id << ": " << session.keyframe_count << " keyframes"
         << (session.object_id.empty() ? "" : ", object " + session.object_id) << (session.closed ? "" : ", still open")
         << "\n";
  }
  text << output.json["sessions"].size() << " session(s)\n";
  output.text = text.str();
  return output;
}

CommandOutput run(const std::string& path)
{
  namespace fs = std::filesystem;
  // Opening a store makes it where there is none; asking about nothing must not.
  if (!fs::exists(path) && path.find("://") == std::string::npos)
    throw base::Error(base::StatusCode::NOT_FOUND, "'" + path + "': no such object database or keyframe store");
  return fs::is_directory(path) ? describeDatabase(path) : describeStore(path);
}
}  // namespace

void addInfoCommand(CLI::App& app, Command* chosen)
{
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("info", "What an object database or a keyframe store holds");
  command
      ->add_option("path", *path, "Folder of an object database, or a keyframe store (SQLite file or postgresql://...)")
      ->required();
  command->callback([path, chosen] { *chosen = [path](base::JobControl&) { return run(*path); }; });
}

}  // namespace object_modelling::cli
