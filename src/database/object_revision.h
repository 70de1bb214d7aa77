#pragma once

#include <map>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"

namespace object_modelling::database
{
/// An object's folder copied into an empty one, then changed there.

/// Copies the folder and gives the object another id, also as its name where that was the id. Returns the text of the
/// new object.yaml, which has been written.
std::string copyRenamed(const std::string& folder, const std::string& copy, const std::string& object_id,
                        const std::string& new_id);

/// Aliases of one object with the id and aliases of another, in this order and each once; of their folders.
std::vector<std::string> aliasesWith(const std::string& folder, const std::string& absorbed_folder);
/// Copies the folder with other aliases. Returns the text of the new object.yaml, which has been written.
std::string copyWithAliases(const std::string& folder, const std::string& copy,
                            const std::vector<std::string>& aliases);

/// Copies the folder and adds what schema version 2 has: properties of the mesh, collision parts, marks of what was
/// seen. Returns the text of the new object.yaml. Throws base::Error (BAD_INPUT) for an object.yaml that we did not
/// write.
std::string copyMigrated(const std::string& folder, const std::string& copy, base::JobControl& control);

}  // namespace object_modelling::database
