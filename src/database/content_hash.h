#pragma once

#include <map>
#include <string>

namespace object_modelling::database
{
/// SHA-256 as 64 hexadecimal digits.
std::string hashOfText(const std::string& text);
/// Throws base::Error (NOT_FOUND, STORAGE).
std::string hashOfFile(const std::string& path);

/// Of every file in a folder, by path relative to it, sorted; without object.yaml, which holds this list, and without
/// recognition/, which is derived from the object and carries the hash of what it was derived from.
std::map<std::string, std::string> hashesOfFolder(const std::string& folder);

}  // namespace object_modelling::database
