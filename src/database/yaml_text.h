#pragma once

#include <string>

#include <yaml-cpp/yaml.h>
#include <Eigen/Geometry>

#include "object_modelling/base/yaml_number.h"

namespace object_modelling::database
{
constexpr int SCHEMA_VERSION = 1;  ///< of manifest.yaml and object.yaml
constexpr char UNIT[] = "metre";
constexpr char HANDEDNESS[] = "right";

using base::yamlNumber;
/// One flow-style list per row.
void emitTransform(YAML::Emitter& out, const Eigen::Isometry3d& T_target_source);
/// Throws YAML::Exception unless it is four rows of four numbers.
Eigen::Isometry3d transformFromYaml(const YAML::Node& node);

/// Text of a manifest.yaml or object.yaml; `path` for messages. Throws base::Error: BAD_INPUT (not YAML), STORAGE
/// (newer schema, both versions named).
YAML::Node parseYaml(const std::string& text, const std::string& path);

}  // namespace object_modelling::database
