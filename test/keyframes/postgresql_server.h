#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "store_fixtures.h"

namespace object_modelling::keyframes
{
/// A PostgreSQL cluster of our own, reachable through a socket in a temporary folder only, so it takes no port and
/// disturbs no other server. Runs as an unprivileged user (the server refuses root), ends with the test process.
class PostgresqlServer
{
public:
  /// The one server of this process, started at the first call. Null if PostgreSQL is not installed.
  static PostgresqlServer* shared();
  ~PostgresqlServer();
  PostgresqlServer(const PostgresqlServer&) = delete;
  PostgresqlServer& operator=(const PostgresqlServer&) = delete;

  /// Connection string of a new, empty database.
  std::string createDatabase();
  void start();
  void stop();

private:
  explicit PostgresqlServer(const std::string& programs);
  std::string connection(const std::string& database) const;

  std::string programs_;
  TemporaryFolder folder_;
  pid_t server_ = -1;
  int databases_ = 0;
};

}  // namespace object_modelling::keyframes
