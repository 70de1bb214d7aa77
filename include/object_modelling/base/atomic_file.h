#pragma once

#include <functional>
#include <string>

namespace object_modelling::base
{
/// Files appear whole or not at all: written beside their place, flushed to disk, then renamed over it. A power cut
/// leaves the old file or the new one. Every function throws base::Error (STORAGE) naming the path and the system's
/// reason; what was there before stays untouched.

/// Calls `write` with the path of a temporary file in the folder of `path` (same extension, since image and mesh
/// writers choose the format by it), then puts that file in place. The temporary is removed if `write` throws. The
/// folder must exist.
void writeFileAtomically(const std::string& path, const std::function<void(const std::string& temporary)>& write);

void writeTextFile(const std::string& path, const std::string& text);

/// Whole file. Throws base::Error: NOT_FOUND if there is none, STORAGE if it cannot be read.
std::string readTextFile(const std::string& path);

/// Flushes a file's or a folder's entry to disk; for folders that are written elsewhere and then renamed.
void syncToDisk(const std::string& path);

}  // namespace object_modelling::base
