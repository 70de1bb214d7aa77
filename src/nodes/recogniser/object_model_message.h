#pragma once

#include <string>

#include <object_modelling/ObjectModel.h>

namespace object_modelling::nodes
{
/// An object as the database at `root` has it now. Throws base::Error: NOT_FOUND (no database, unknown id; names those
/// that are known), BAD_INPUT (damaged; names the file), STORAGE.
object_modelling::ObjectModel objectModelMessage(const std::string& root, const std::string& object_id);

}  // namespace object_modelling::nodes
