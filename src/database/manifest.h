#pragma once

#include <map>
#include <string>

namespace object_modelling::database
{
/// A manifest's entry for one object.
struct ListedObject
{
  std::string content_hash;
  bool partial = false;  ///< as in its object.yaml
};

/// manifest.yaml: which objects a database holds, in which state.
struct Manifest
{
  std::string unit, handedness;                 ///< as written in the file
  std::map<std::string, ListedObject> objects;  ///< by id
};

std::string manifestPath(const std::string& root);
/// Throws base::Error: NOT_FOUND, BAD_INPUT, STORAGE (newer schema).
Manifest readManifest(const std::string& path);
/// Atomic. Throws base::Error (STORAGE).
void writeManifest(const std::string& path, const std::map<std::string, ListedObject>& objects);

}  // namespace object_modelling::database
