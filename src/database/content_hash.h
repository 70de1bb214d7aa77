#pragma once

#include <map>
#include <string>
#include <vector>

namespace object_modelling::database
{
/// SHA-256 as 64 hexadecimal digits.
std::string hashOfText(const std::string& text);
/// Throws base::Error (NOT_FOUND, STORAGE).
std::string hashOfFile(const std::string& path);

/// Of every file in a folder, by path relative to it, sorted; without object.yaml, which holds this list, without
/// recognition/, which is derived from the object and carries the hash of what it was derived from, and without the
/// report, which contains the time of the build and so differs every time.
std::map<std::string, std::string> hashesOfFolder(const std::string& folder);

/// Writes report.sha256: the hashes of those files of the report that are there, as sha256sum does.
void sealReport(const std::string& folder);
/// One message for each file of the report that is missing, changed or not listed in report.sha256.
std::vector<std::string> checkReport(const std::string& folder);

}  // namespace object_modelling::database
