#pragma once

#include <optional>
#include <string>

#include <yaml-cpp/yaml.h>

#include "object_modelling/object_properties/object_properties.h"

namespace object_modelling::database
{
/// The keys of object.yaml that schema version 2 brought, into an open map.
void emitProperties(YAML::Emitter& out, const object_properties::ObjectProperties& properties);
/// None where the file has none of them; without the meshes of the collision parts. Throws YAML::Exception.
std::optional<object_properties::ObjectProperties> propertiesFrom(const YAML::Node& object);
int collisionPartCount(const YAML::Node& object);
/// Relative to the object's folder.
std::string collisionFile(int index);

bool isFinite(const object_properties::ObjectProperties& properties);

}  // namespace object_modelling::database
