#pragma once

#include <functional>
#include <vector>

#include "sql_connection.h"

namespace object_modelling::keyframes
{
/// One step of the schema: element i of a list of migrations takes a store of version i to version i + 1. A new store
/// is an empty database, version 0, that goes through all of them.
using Migration = std::function<void(soci::session&, const SqlDialect&)>;

/// Those of this program; the current schema version is their number. Never change one that has been released.
const std::vector<Migration>& storeMigrations();

/// Brings the store to the last version in one transaction. Throws base::Error: STORAGE for a store of a newer version,
/// BAD_INPUT for a database that holds other things.
void migrate(SqlConnection& connection, const std::vector<Migration>& migrations);

}  // namespace object_modelling::keyframes
