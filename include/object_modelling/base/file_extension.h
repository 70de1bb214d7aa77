#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace object_modelling::base
{
/// Extension of a path in lower case, with its dot: ".ply"; empty where there is none.
inline std::string lowerExtension(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace object_modelling::base
