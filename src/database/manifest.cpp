#include "manifest.h"

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"
#include "object_modelling/keyframes/session.h"
#include "yaml_text.h"

namespace object_modelling::database
{
std::string manifestPath(const std::string& root)
{
  return root + "/manifest.yaml";
}

Manifest readManifest(const std::string& path)
{
  const YAML::Node node = parseYaml(base::readTextFile(path), path);
  Manifest manifest;
  try
  {
    manifest.unit = node["unit"].as<std::string>();
    manifest.handedness = node["handedness"].as<std::string>();
    for (const YAML::Node& object : node["objects"])
      manifest.objects[object["id"].as<std::string>()] = { object["content_hash"].as<std::string>(),
                                                           object["partial"] && object["partial"].as<bool>() };
  }
  catch (const YAML::Exception& error)
  {
    throw base::Error(base::StatusCode::BAD_INPUT, path + " is no manifest of an object database: " + error.what());
  }
  for (const auto& [id, listed] : manifest.objects)
    if (!keyframes::isValidId(id))
      throw base::Error(base::StatusCode::BAD_INPUT, path + " lists '" + id + "', which is no object id");
  return manifest;
}

void writeManifest(const std::string& path, const std::map<std::string, ListedObject>& objects)
{
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "schema_version" << YAML::Value << SCHEMA_VERSION;
  out << YAML::Key << "unit" << YAML::Value << UNIT;
  out << YAML::Key << "handedness" << YAML::Value << HANDEDNESS;
  out << YAML::Key << "objects" << YAML::Value << YAML::BeginSeq;
  for (const auto& [id, listed] : objects)
    out << YAML::BeginMap << YAML::Key << "id" << YAML::Value << YAML::DoubleQuoted << id << YAML::Key << "content_hash"
        << YAML::Value << listed.content_hash << YAML::Key << "partial" << YAML::Value << listed.partial
        << YAML::EndMap;
  out << YAML::EndSeq << YAML::EndMap;
  base::writeTextFile(path, std::string(out.c_str()) + "\n");
}

}  // namespace object_modelling::database
