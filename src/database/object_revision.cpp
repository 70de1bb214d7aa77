#include "object_revision.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "content_hash.h"
#include "object_files.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"
#include "object_modelling/database/cloud_file.h"
#include "object_modelling/database/mesh_evidence.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_yaml.h"
#include "properties_yaml.h"
#include "yaml_text.h"

namespace object_modelling::database
{
namespace
{
namespace fs = std::filesystem;

constexpr double DEFAULT_RESOLUTION_M = 0.002;  // of fusion, where the object does not tell
constexpr double SEEN_RESOLUTIONS = 2;

/// Keys at the left margin, as objectYaml() writes them: what else is in the file stays byte for byte.
std::size_t placeOf(const std::string& key, const std::string& text, const std::string& path)
{
  const std::size_t place = text.rfind("\n" + key + ":");
  if (place == std::string::npos && text.rfind(key + ":", 0) != 0)
    throw base::Error(base::StatusCode::BAD_INPUT, path + " has no key '" + key + "': it is no file of ours");
  return place == std::string::npos ? 0 : place + 1;
}

void replaceLine(const std::string& key, const std::string& value, const std::string& path, std::string* text)
{
  const std::size_t begin = placeOf(key, *text, path);
  const std::size_t end = text->find('\n', begin);
  text->replace(begin, end - begin, key + ": " + value);
}

std::string quoted(const std::string& text)
{
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

double resolutionOf(const YAML::Node& object)
{
  const YAML::Node text = object["provenance"]["fusion_resolution_m"];
  const double resolution_m = text ? std::atof(text.as<std::string>().c_str()) : 0;
  return resolution_m > 0 ? resolution_m : DEFAULT_RESOLUTION_M;
}

std::string propertiesText(const object_properties::ObjectProperties& properties)
{
  YAML::Emitter out;
  out << YAML::BeginMap;
  emitProperties(out, properties);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

std::string filesText(const std::string& folder)
{
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "files" << YAML::Value << YAML::BeginMap;
  for (const auto& [file, hash] : hashesOfFolder(folder))
    out << YAML::Key << file << YAML::Value << hash;
  out << YAML::EndMap << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}
}  // namespace

std::string copyRenamed(const std::string& folder, const std::string& copy, const std::string& object_id,
                        const std::string& new_id)
{
  const std::string path = copy + "/object.yaml";
  const bool named = readObject(folder).entry.name != object_id;
  fs::copy(folder, copy, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  std::string text = base::readTextFile(path);
  replaceLine("id", quoted(new_id), path, &text);
  if (!named)
    replaceLine("name", quoted(new_id), path, &text);
  base::writeTextFile(path, text);
  return text;
}

std::vector<std::string> aliasesWith(const std::string& folder, const std::string& absorbed_folder)
{
  const ObjectEntry entry = readObject(folder).entry, absorbed = readObject(absorbed_folder).entry;
  std::vector<std::string> aliases = entry.aliases;
  aliases.push_back(absorbed.id);
  aliases.insert(aliases.end(), absorbed.aliases.begin(), absorbed.aliases.end());
  std::vector<std::string> once;
  for (const std::string& alias : aliases)
    if (alias != entry.id && std::find(once.begin(), once.end(), alias) == once.end())
      once.push_back(alias);
  return once;
}

std::string copyWithAliases(const std::string& folder, const std::string& copy, const std::vector<std::string>& aliases)
{
  fs::copy(folder, copy, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  const std::string path = copy + "/object.yaml";
  std::string text = base::readTextFile(path);
  std::string list;
  for (const std::string& alias : aliases)
    list += (list.empty() ? "" : ", ") + quoted(alias);
  if (text.find("\naliases:") == std::string::npos)  // files of before lack it
    text.insert(placeOf("unit", text, path), "aliases: []\n");
  replaceLine("aliases", "[" + list + "]", path, &text);
  base::writeTextFile(path, text);
  return text;
}

std::string copyMigrated(const std::string& folder, const std::string& copy, base::JobControl& control)
{
  const ObjectEntry entry = readObject(folder).entry;
  fs::copy(folder, copy, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  const std::string path = copy + "/object.yaml";
  std::string text = base::readTextFile(path);
  mesh::TriangleMesh mesh = mesh::readMesh(copy + "/mesh/mesh.ply");
  const fusion::FusedCloud cloud = readCloud(copy + "/cloud.pcd");
  markSeen(cloud, SEEN_RESOLUTIONS * resolutionOf(parseYaml(text, path)), &mesh);
  const object_properties::ObjectProperties properties =
      object_properties::propertiesOf(mesh, entry.T_support_model, {}, control);
  mesh::writeMesh(copy + "/mesh/mesh.ply", mesh, sigmasOf(cloud, mesh));
  writeCollisionParts(copy, properties);
  replaceLine("schema_version", std::to_string(SCHEMA_VERSION), path, &text);
  text.resize(placeOf("files", text, path));
  text.insert(placeOf("cloud_point_count", text, path), propertiesText(properties));
  text += filesText(copy);
  base::writeTextFile(path, text);
  return text;
}

}  // namespace object_modelling::database
