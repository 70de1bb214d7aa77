#pragma once

#include <string>

#include "sql_connection.h"

namespace object_modelling::keyframes
{
/// One session as a SQLite file of its own: written beside its place under another name, then renamed. Throws
/// base::Error: FAILED_PRECONDITION if `path` exists, NOT_FOUND, STORAGE.
void writeSessionFile(SqlConnection& store, const std::string& session_id, const std::string& path);

/// Adds the one session of such a file, whole or not at all; returns its id. The file is only read, so it may be write
/// protected. Throws base::Error: NOT_FOUND (file), BAD_INPUT (not such a file, damaged), FAILED_PRECONDITION (the
/// store has a session of that id).
std::string readSessionFile(SqlConnection& store, const std::string& path);

}  // namespace object_modelling::keyframes
