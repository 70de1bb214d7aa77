#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "sql_dialect.h"

namespace object_modelling::keyframes
{
/// One database session. Runs bodies as transactions, one at a time: committed whole, or rolled back and the failure
/// thrown as base::Error. A lost server connection is opened again by the next call. Safe for several threads.
class SqlConnection
{
public:
  using Body = std::function<void(soci::session&)>;

  /// Connects.
  explicit SqlConnection(std::unique_ptr<SqlDialect> dialect);

  void read(const std::string& subject, const Body& body) { run(subject, dialect_->beginRead(), body); }
  void write(const std::string& subject, const Body& body) { run(subject, dialect_->beginWrite(), body); }
  const SqlDialect& dialect() const { return *dialect_; }

private:
  void run(const std::string& subject, const std::string& begin, const Body& body);

  std::unique_ptr<SqlDialect> dialect_;
  std::mutex mutex_;
  soci::session sql_;
  bool connected_ = false;
};

}  // namespace object_modelling::keyframes
