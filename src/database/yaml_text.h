#pragma once

#include <string>

#include <yaml-cpp/yaml.h>
#include <Eigen/Geometry>

#include "object_modelling/base/yaml_number.h"

namespace object_modelling::database
{
constexpr int SCHEMA_VERSION = 2;  ///< of manifest.yaml and object.yaml
constexpr char UNIT[] = "metre";
constexpr char HANDEDNESS[] = "right";

using base::yamlNumber;
/// One flow-style list per row.
void emitTransform(YAML::Emitter& out, const Eigen::Isometry3d& T_target_source);
/// Throws YAML::Exception unless it is four rows of four numbers.
Eigen::Isometry3d transformFromYaml(const YAML::Node& node);

/// Flow-style list of all numbers, row by row.
template <typename Derived>
void emitNumbers(YAML::Emitter& out, const Eigen::MatrixBase<Derived>& matrix)
{
  out << YAML::Flow << YAML::BeginSeq;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index column = 0; column < matrix.cols(); ++column)
      out << yamlNumber(matrix(row, column));
  out << YAML::EndSeq;
}
/// Throws YAML::Exception unless it is a list of as many numbers as the matrix has.
template <typename Derived>
void numbersFromYaml(const YAML::Node& node, Eigen::MatrixBase<Derived>* matrix)
{
  const auto count = static_cast<std::size_t>(matrix->size());
  if (!node.IsSequence() || node.size() != count)
    throw YAML::Exception(node.Mark(), "a list of " + std::to_string(count) + " numbers is needed");
  for (std::size_t i = 0; i < count; ++i)
    (*matrix)(static_cast<Eigen::Index>(i) / matrix->cols(), static_cast<Eigen::Index>(i) % matrix->cols()) =
        node[i].as<double>();
}

/// Text of a manifest.yaml or object.yaml; `path` for messages. Throws base::Error: BAD_INPUT (not YAML), STORAGE
/// (newer schema, both versions named).
YAML::Node parseYaml(const std::string& text, const std::string& path);

}  // namespace object_modelling::database
