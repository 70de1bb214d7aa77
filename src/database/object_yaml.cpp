#include "object_yaml.h"

#include <algorithm>

#include "content_hash.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"
#include "properties_yaml.h"
#include "yaml_text.h"

namespace object_modelling::database
{
namespace
{
void emitSessions(YAML::Emitter& out, const ObjectModel& model)
{
  out << YAML::Key << "sessions" << YAML::Value << YAML::BeginSeq;
  for (const ModelSession& session : model.sessions)
  {
    out << YAML::BeginMap << YAML::Key << "id" << YAML::Value << YAML::DoubleQuoted << session.id;
    out << YAML::Key << "keyframe_count" << YAML::Value << session.keyframe_count;
    out << YAML::Key << "model_from_session" << YAML::Value;
    emitTransform(out, session.T_model_session);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void emitLeftOut(YAML::Emitter& out, const ObjectModel& model)
{
  out << YAML::Key << "partial" << YAML::Value << !model.sessions_left_out.empty();
  out << YAML::Key << "sessions_left_out" << YAML::Value << YAML::BeginSeq;
  for (const LeftOutSession& session : model.sessions_left_out)
    out << YAML::BeginMap << YAML::Key << "id" << YAML::Value << YAML::DoubleQuoted << session.id << YAML::Key
        << "reason" << YAML::Value << YAML::DoubleQuoted << session.reason << YAML::EndMap;
  out << YAML::EndSeq;
}

void emitViews(YAML::Emitter& out, const ObjectModel& model)
{
  out << YAML::Key << "views" << YAML::Value << YAML::BeginSeq;
  for (std::size_t i = 0; i < model.views.size(); ++i)
  {
    const rgbd::Frame& frame = model.views[i].frame;
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "index" << YAML::Value << i;
    out << YAML::Key << "stamp_s" << YAML::Value << yamlNumber(frame.stamp_s);
    out << YAML::Key << "width_px" << YAML::Value << frame.camera.width;
    out << YAML::Key << "height_px" << YAML::Value << frame.camera.height;
    out << YAML::Key << "fx_px" << YAML::Value << yamlNumber(frame.camera.fx);
    out << YAML::Key << "fy_px" << YAML::Value << yamlNumber(frame.camera.fy);
    out << YAML::Key << "cx_px" << YAML::Value << yamlNumber(frame.camera.cx);
    out << YAML::Key << "cy_px" << YAML::Value << yamlNumber(frame.camera.cy);
    const auto session = static_cast<std::size_t>(model.views[i].session_index);
    if (session < model.sessions.size())
      out << YAML::Key << "session" << YAML::Value << YAML::DoubleQuoted << model.sessions[session].id;
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

template <typename Value, typename Text>
void emitMap(YAML::Emitter& out, const char* key, const std::map<std::string, Value>& values, const Text& text)
{
  out << YAML::Key << key << YAML::Value << YAML::BeginMap;
  for (const auto& [name, value] : values)
    out << YAML::Key << name << YAML::Value << text(value);
  out << YAML::EndMap;
}

/// The times in which the sessions' views were taken.
void readStamps(const YAML::Node& views, std::vector<ModelSession>* sessions)
{
  for (const YAML::Node& view : views)
    for (ModelSession& session : *sessions)
      if (view["session"] && view["session"].as<std::string>() == session.id)
      {
        const auto stamp_s = view["stamp_s"].as<double>();
        const bool first = session.last_stamp_s < session.first_stamp_s;
        session.first_stamp_s = first ? stamp_s : std::min(session.first_stamp_s, stamp_s);
        session.last_stamp_s = first ? stamp_s : std::max(session.last_stamp_s, stamp_s);
      }
}

ObjectEntry entryFrom(const YAML::Node& node)
{
  ObjectEntry entry;
  entry.id = node["id"].as<std::string>();
  entry.name = node["name"].as<std::string>();
  for (const YAML::Node& alias : node["aliases"])  // files of before lack it, and frame_version
    entry.aliases.push_back(alias.as<std::string>());
  if (node["frame_version"])
    entry.frame_version = node["frame_version"].as<int>();
  for (int i = 0; i < 3; ++i)
    entry.size_m[i] = node["size_m"][i].as<double>();
  entry.box_model = { transformFromYaml(node["model_from_box"]), entry.size_m };
  for (const YAML::Node& support_from_model : node["support_from_model"])
    entry.T_support_model.push_back(transformFromYaml(support_from_model));
  entry.diameter_m = node["diameter_m"].as<double>();
  for (const YAML::Node& session : node["sessions"])
    entry.sessions.push_back({ session["id"].as<std::string>(), transformFromYaml(session["model_from_session"]),
                               session["keyframe_count"].as<int>() });
  readStamps(node["views"], &entry.sessions);
  if (node["partial"])  // files of before lack it, and sessions_left_out
    entry.partial = node["partial"].as<bool>();
  for (const YAML::Node& session : node["sessions_left_out"])
    entry.sessions_left_out.push_back({ session["id"].as<std::string>(), session["reason"].as<std::string>() });
  for (const auto& figure : node["quality"])
    entry.quality[figure.first.as<std::string>()] = figure.second.as<double>();
  entry.schema_version = node["schema_version"].as<int>();
  entry.properties = propertiesFrom(node);
  return entry;
}
}  // namespace

std::string objectYaml(const ObjectModel& model, const std::map<std::string, std::string>& file_hashes)
{
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "schema_version" << YAML::Value << SCHEMA_VERSION;
  out << YAML::Key << "id" << YAML::Value << YAML::DoubleQuoted << model.id;
  out << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted << (model.name.empty() ? model.id : model.name);
  out << YAML::Key << "aliases" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const std::string& alias : model.aliases)
    out << YAML::DoubleQuoted << alias;
  out << YAML::EndSeq;
  out << YAML::Key << "frame_version" << YAML::Value << model.frame_version;
  out << YAML::Key << "unit" << YAML::Value << UNIT;
  out << YAML::Key << "handedness" << YAML::Value << HANDEDNESS;
  out << YAML::Key << "size_m" << YAML::Value;
  emitNumbers(out, model.box_model.size_m);
  out << YAML::Key << "diameter_m" << YAML::Value << yamlNumber(model.diameter_m);
  out << YAML::Key << "model_from_box" << YAML::Value;
  emitTransform(out, model.box_model.T_frame_box);
  out << YAML::Key << "support_from_model" << YAML::Value << YAML::BeginSeq;
  for (const Eigen::Isometry3d& T_support_model : model.T_support_model)
    emitTransform(out, T_support_model);
  out << YAML::EndSeq;
  emitSessions(out, model);
  emitLeftOut(out, model);
  emitMap(out, "quality", model.quality, yamlNumber);
  emitMap(out, "provenance", model.provenance, [](const std::string& text) { return text; });
  if (model.properties)
    emitProperties(out, *model.properties);
  out << YAML::Key << "cloud_point_count" << YAML::Value << model.cloud.size();
  out << YAML::Key << "mesh_vertex_count" << YAML::Value << model.mesh.vertices.size();
  out << YAML::Key << "mesh_triangle_count" << YAML::Value << model.mesh.triangles.size();
  emitViews(out, model);
  emitMap(out, "files", file_hashes, [](const std::string& hash) { return hash; });
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

ObjectDescription readObject(const std::string& folder)
{
  const std::string path = folder + "/object.yaml";
  const std::string text = base::readTextFile(path);
  const YAML::Node node = parseYaml(text, path);
  ObjectDescription object;
  try
  {
    object.entry = entryFrom(node);
    for (int i = 0; i < collisionPartCount(node); ++i)
      object.entry.collision_paths.push_back(folder + "/" + collisionFile(i));
    object.unit = node["unit"].as<std::string>();
    object.handedness = node["handedness"].as<std::string>();
    for (const auto& file : node["files"])
      object.file_hashes[file.first.as<std::string>()] = file.second.as<std::string>();
  }
  catch (const YAML::Exception& error)
  {
    throw base::Error(base::StatusCode::BAD_INPUT, path + " does not describe an object: " + error.what());
  }
  object.entry.content_hash = hashOfText(text);
  object.entry.mesh_path = folder + "/mesh/mesh.ply";
  return object;
}

}  // namespace object_modelling::database
