#include "every_backend.h"

#include "postgresql_server.h"

namespace object_modelling::keyframes
{
void OnEveryBackend::SetUp()
{
  if (GetParam() == "sqlite")
    connection_ = folder_.path("store.db");
  else if (PostgresqlServer* server = PostgresqlServer::shared())
    connection_ = server->createDatabase();
  else
    GTEST_SKIP() << "PostgreSQL's server is not installed (package postgresql)";
}

std::unique_ptr<SqlDialect> OnEveryBackend::dialect() const
{
  return GetParam() == "sqlite" ? makeSqliteDialect(connection_, JournalMode::WAL) : makePostgresqlDialect(connection_);
}
}  // namespace object_modelling::keyframes
