#pragma once

#include <map>
#include <string>

namespace object_modelling::database
{
/// manifest.yaml: which objects a database holds, in which state.
struct Manifest
{
  std::string unit, handedness;                ///< as written in the file
  std::map<std::string, std::string> objects;  ///< content hash by object id
};

std::string manifestPath(const std::string& root);
/// Throws base::Error: NOT_FOUND, BAD_INPUT, STORAGE (newer schema).
Manifest readManifest(const std::string& path);
/// Atomic. Throws base::Error (STORAGE).
void writeManifest(const std::string& path, const std::map<std::string, std::string>& objects);

}  // namespace object_modelling::database
