#include "sql_connection.h"

#include <utility>

namespace object_modelling::keyframes
{
namespace
{
/// Rolls back unless committed. A rollback may itself fail (SQLite has done it already, the server is gone): whatever
/// is left of the transaction then ends with the connection.
class Transaction
{
public:
  Transaction(soci::session& sql, const std::string& begin) : sql_(sql) { sql_ << begin; }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction()
  {
    if (committed_)
      return;
    try
    {
      sql_ << "ROLLBACK";
    }
    catch (const soci::soci_error&)
    {
      return;
    }
  }
  void commit()
  {
    sql_ << "COMMIT";
    committed_ = true;
  }

private:
  soci::session& sql_;
  bool committed_ = false;
};
}  // namespace

SqlConnection::SqlConnection(std::unique_ptr<SqlDialect> dialect) : dialect_(std::move(dialect))
{
  read("opening", [](soci::session&) {});
}

void SqlConnection::run(const std::string& subject, const std::string& begin, const Body& body)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  try
  {
    if (!connected_)
    {
      sql_.close();
      dialect_->connect(sql_);
      connected_ = true;
    }
    Transaction transaction(sql_, begin);
    body(sql_);
    transaction.commit();
  }
  catch (const soci::soci_error& error)
  {
    if (dialect_->connectionLost(error))
      connected_ = false;
    // Not what(): its context quotes the statement's parameters, whole images among them.
    const base::Status status = dialect_->explain(error);
    throw base::Error(status.code, subject + ": " + dialect_->storeName() + ": " + status.message + " (" +
                                       error.get_error_message() + "); nothing was changed");
  }
}

}  // namespace object_modelling::keyframes
