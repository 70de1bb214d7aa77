#include "properties_yaml.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "yaml_text.h"

namespace object_modelling::database
{
namespace
{
using object_properties::MassProperties;
using object_properties::ObjectProperties;
using object_properties::RestingPose;
using object_properties::Solid;
using object_properties::Symmetry;
using object_properties::Unseen;

constexpr std::array<const char*, 3> SOLIDS{ "mesh", "closed_mesh", "hull" };  // in the order of Solid

template <typename Value>
void put(YAML::Emitter& out, const char* key, const Value& value)
{
  out << YAML::Key << key << YAML::Value << value;
}

template <typename Derived>
void putNumbers(YAML::Emitter& out, const char* key, const Eigen::MatrixBase<Derived>& matrix)
{
  out << YAML::Key << key << YAML::Value;
  emitNumbers(out, matrix);
}

void emitMass(YAML::Emitter& out, const MassProperties& mass)
{
  out << YAML::Key << "mass_properties" << YAML::Value << YAML::BeginMap;
  put(out, "closed", mass.closed);
  put(out, "of", SOLIDS.at(static_cast<std::size_t>(mass.of)));
  put(out, "volume_m3", yamlNumber(mass.volume_m3));
  putNumbers(out, "center_of_mass_m", mass.center_of_mass_m);
  putNumbers(out, "inertia_per_density_m5", mass.inertia_per_density_m5);
  put(out, "density_kg_m3", yamlNumber(mass.density_kg_m3));
  put(out, "mass_kg", yamlNumber(mass.mass_kg));
  out << YAML::EndMap;
}

void emitSymmetry(YAML::Emitter& out, const Symmetry& symmetry)
{
  out << YAML::BeginMap;
  put(out, "of", symmetry.of == Symmetry::Of::SHAPE ? "shape" : "texture");
  put(out, "kind", symmetry.continuous() ? "continuous" : "discrete");
  putNumbers(out, "axis", symmetry.axis);
  putNumbers(out, "point_m", symmetry.point_m);
  put(out, "order", symmetry.order);
  put(out, "error_mm", yamlNumber(1000 * symmetry.error_m));
  out << YAML::EndMap;
}

MassProperties massFrom(const YAML::Node& node)
{
  MassProperties mass;
  mass.closed = node["closed"].as<bool>();
  const auto of = node["of"].as<std::string>();
  std::size_t solid = 0;
  while (solid < SOLIDS.size() && of != SOLIDS[solid])
    ++solid;
  if (solid == SOLIDS.size())
    throw YAML::Exception(node["of"].Mark(), "mass_properties are of mesh, closed_mesh or hull, not of '" + of + "'");
  mass.of = static_cast<Solid>(solid);
  mass.volume_m3 = node["volume_m3"].as<double>();
  numbersFromYaml(node["center_of_mass_m"], &mass.center_of_mass_m);
  numbersFromYaml(node["inertia_per_density_m5"], &mass.inertia_per_density_m5);
  mass.density_kg_m3 = node["density_kg_m3"].as<double>();
  mass.mass_kg = node["mass_kg"].as<double>();
  return mass;
}

Symmetry symmetryFrom(const YAML::Node& node)
{
  const auto of = node["of"].as<std::string>(), kind = node["kind"].as<std::string>();
  Symmetry symmetry;
  symmetry.of = of == "shape" ? Symmetry::Of::SHAPE : Symmetry::Of::TEXTURE;
  numbersFromYaml(node["axis"], &symmetry.axis);
  numbersFromYaml(node["point_m"], &symmetry.point_m);
  symmetry.order = node["order"].as<int>();
  symmetry.error_m = node["error_mm"].as<double>() / 1000;
  if ((of != "shape" && of != "texture") || (kind != "continuous" && kind != "discrete") ||
      symmetry.continuous() != (kind == "continuous"))
    throw YAML::Exception(node.Mark(), "a symmetry is of shape or texture, and discrete with an order or continuous");
  return symmetry;
}
}  // namespace

void emitProperties(YAML::Emitter& out, const ObjectProperties& properties)
{
  emitMass(out, properties.mass);
  out << YAML::Key << "resting_poses" << YAML::Value << YAML::BeginSeq;
  for (const RestingPose& pose : properties.resting_poses)
  {
    out << YAML::BeginMap;
    putNumbers(out, "support_from_model", pose.T_support_model.matrix());
    put(out, "probability", yamlNumber(pose.probability));
    put(out, "seen", pose.seen);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::Key << "symmetries" << YAML::Value << YAML::BeginSeq;
  for (const Symmetry& symmetry : properties.symmetries)
    emitSymmetry(out, symmetry);
  out << YAML::EndSeq;
  put(out, "collision_parts", properties.collision_parts.size());
  if (!properties.unseen)
    return;
  out << YAML::Key << "unseen" << YAML::Value << YAML::BeginMap;
  put(out, "ratio", yamlNumber(properties.unseen->ratio));
  put(out, "bottom", properties.unseen->bottom);
  out << YAML::EndMap;
}

std::optional<ObjectProperties> propertiesFrom(const YAML::Node& object)
{
  if (!object["mass_properties"])
    return std::nullopt;
  ObjectProperties properties;
  properties.mass = massFrom(object["mass_properties"]);
  for (const YAML::Node& node : object["resting_poses"])
  {
    RestingPose pose;
    numbersFromYaml(node["support_from_model"], &pose.T_support_model.matrix());
    pose.probability = node["probability"].as<double>();
    pose.seen = node["seen"].as<bool>();
    properties.resting_poses.push_back(pose);
  }
  for (const YAML::Node& node : object["symmetries"])
    properties.symmetries.push_back(symmetryFrom(node));
  if (const YAML::Node unseen = object["unseen"])
    properties.unseen = Unseen{ unseen["ratio"].as<double>(), unseen["bottom"].as<bool>() };
  return properties;
}

int collisionPartCount(const YAML::Node& object)
{
  constexpr int MAX_PARTS = 10000;
  const int count = object["collision_parts"] ? object["collision_parts"].as<int>() : 0;
  if (count < 0 || count > MAX_PARTS)
    throw YAML::Exception(object["collision_parts"].Mark(), "collision_parts is a count of files");
  return count;
}

std::string collisionFile(int index)
{
  std::array<char, 40> name{};
  std::snprintf(name.data(), name.size(), "mesh/collision_%02d.ply", index);
  return name.data();
}

bool isFinite(const ObjectProperties& properties)
{
  const MassProperties& mass = properties.mass;
  bool finite = std::isfinite(mass.volume_m3) && mass.center_of_mass_m.allFinite() &&
                mass.inertia_per_density_m5.allFinite() && std::isfinite(mass.density_kg_m3) &&
                std::isfinite(mass.mass_kg);
  for (const RestingPose& pose : properties.resting_poses)
    finite = finite && pose.T_support_model.matrix().allFinite() && std::isfinite(pose.probability);
  for (const Symmetry& symmetry : properties.symmetries)
    finite = finite && symmetry.axis.allFinite() && symmetry.point_m.allFinite() && std::isfinite(symmetry.error_m);
  return finite;
}

}  // namespace object_modelling::database
