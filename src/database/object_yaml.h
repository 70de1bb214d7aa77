#pragma once

#include <map>
#include <string>

#include "object_modelling/database/object_database.h"

namespace object_modelling::database
{
/// Text of object.yaml; `file_hashes` by relative path. The same model gives the same text.
std::string objectYaml(const ObjectModel& model, const std::map<std::string, std::string>& file_hashes);

struct ObjectDescription
{
  ObjectEntry entry;
  std::string unit, handedness;
  std::map<std::string, std::string> file_hashes;
};
/// Of an object's folder. Throws base::Error: NOT_FOUND, BAD_INPUT, STORAGE (newer schema).
ObjectDescription readObject(const std::string& folder);

}  // namespace object_modelling::database
