#include "yaml_text.h"

#include "object_modelling/base/status.h"

namespace object_modelling::database
{
using base::Error;
using base::StatusCode;

void emitTransform(YAML::Emitter& out, const Eigen::Isometry3d& T_target_source)
{
  out << YAML::BeginSeq;
  for (int row = 0; row < 4; ++row)
  {
    out << YAML::Flow << YAML::BeginSeq;
    for (int column = 0; column < 4; ++column)
      out << yamlNumber(T_target_source(row, column));
    out << YAML::EndSeq;
  }
  out << YAML::EndSeq;
}

Eigen::Isometry3d transformFromYaml(const YAML::Node& node)
{
  Eigen::Isometry3d T;
  if (!node.IsSequence() || node.size() != 4)
    throw YAML::Exception(node.Mark(), "a transform has four rows");
  for (int row = 0; row < 4; ++row)
  {
    if (!node[row].IsSequence() || node[row].size() != 4)
      throw YAML::Exception(node[row].Mark(), "a row of a transform has four numbers");
    for (int column = 0; column < 4; ++column)
      T(row, column) = node[row][column].as<double>();
  }
  return T;
}

YAML::Node parseYaml(const std::string& text, const std::string& path)
{
  int version = 0;
  YAML::Node node;
  try
  {
    node = YAML::Load(text);
    version = node["schema_version"].as<int>();
  }
  catch (const YAML::Exception& error)
  {
    throw Error(StatusCode::BAD_INPUT, path + " cannot be read: " + error.what());
  }
  if (version > SCHEMA_VERSION)
    throw Error(StatusCode::STORAGE, path + " has schema version " + std::to_string(version) +
                                         ", this program knows versions up to " + std::to_string(SCHEMA_VERSION) +
                                         "; update object_modelling");
  return node;
}

}  // namespace object_modelling::database
