#pragma once

#include <memory>

#include "object_modelling/keyframes/session_store.h"
#include "sql_dialect.h"

namespace object_modelling::keyframes
{
/// As openSqlStore(), on any dialect.
std::unique_ptr<SessionStore> makeSqlStore(std::unique_ptr<SqlDialect> dialect);

}  // namespace object_modelling::keyframes
