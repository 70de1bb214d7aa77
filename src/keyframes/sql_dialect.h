#pragma once

#include <memory>
#include <string>
#include <vector>

#include <soci/soci.h>

#include "object_modelling/base/status.h"

namespace object_modelling::keyframes
{
/// Everything in which the databases differ. All other SQL of the store is the same for both.
class SqlDialect
{
public:
  virtual ~SqlDialect() = default;

  /// Store name for messages, without passwords.
  virtual std::string storeName() const = 0;
  /// Opens the session and sets time limits, durability and foreign keys.
  virtual void connect(soci::session& sql) const = 0;
  virtual std::string beginRead() const = 0;   ///< one consistent view of the data
  virtual std::string beginWrite() const = 0;  ///< fails at once rather than half way if another writer is busy
  /// Within a write transaction: keeps other processes from changing tables at the same time.
  virtual void lockSchema(soci::session& sql) const = 0;
  virtual std::vector<std::string> tables(soci::session& sql) const = 0;

  /// Bytes travel as std::string parameters; `parameter` is ":name".
  virtual std::string blobType() const = 0;
  virtual std::string blobValue(const std::string& parameter) const = 0;
  virtual std::string encodeBlob(const std::string& bytes) const = 0;
  virtual std::string decodeBlob(const std::string& text) const = 0;

  /// What went wrong, and what to do about it.
  virtual base::Status explain(const soci::soci_error& error) const = 0;
  /// Whether the session is useless after this error and has to be opened again.
  virtual bool connectionLost(const soci::soci_error& error) const = 0;
};

/// WAL: readers never wait for the writer, and a commit is one sequential write. A rollback journal leaves a single
/// file, for exports.
enum class JournalMode
{
  WAL,
  ROLLBACK,
};
std::unique_ptr<SqlDialect> makeSqliteDialect(const std::string& path, JournalMode journal_mode);
/// "postgresql://user@host:port/database" or "postgresql://host=... dbname=..."
std::unique_ptr<SqlDialect> makePostgresqlDialect(const std::string& connection);

}  // namespace object_modelling::keyframes
