#include <regex>

#include <soci/postgresql/soci-postgresql.h>

#include "sql_dialect.h"

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::Status;
using base::StatusCode;

constexpr char SCHEME[] = "postgresql://";
constexpr char UNREACHABLE[] =
    "the server cannot be reached; check that it runs, its address, user and password, and try again";
constexpr char HEX_DIGITS[] = "0123456789abcdef";

int hexValue(char digit)
{
  if (digit >= '0' && digit <= '9')
    return digit - '0';
  return digit >= 'a' && digit <= 'f' ? digit - 'a' + 10 : -1;
}

std::string sqlStateOf(const soci::soci_error& error)
{
  const auto* postgresql_error = dynamic_cast<const soci::postgresql_soci_error*>(&error);
  return postgresql_error == nullptr ? "" : postgresql_error->sqlstate();
}

class PostgresqlDialect : public SqlDialect
{
public:
  explicit PostgresqlDialect(const std::string& connection)
  {
    // libpq reads both a URI and "keyword=value" pairs, but the latter only without a scheme in front.
    const std::string rest = connection.substr(sizeof(SCHEME) - 1);
    connection_ = std::regex_search(rest, std::regex("^\\s*\\w+\\s*=")) ? rest : connection;
    name_ = std::regex_replace(connection, std::regex("password\\s*=\\s*('[^']*'|[^ &]*)"), "password=***");
    name_ = std::regex_replace(name_, std::regex("//([^:/@]*):[^@/]*@"), "//$1:***@");
  }

  std::string storeName() const override { return "store '" + name_ + "'"; }

  void connect(soci::session& sql) const override
  {
    try
    {
      sql.open(soci::postgresql, connection_);
    }
    catch (const soci::soci_error& error)
    {
      throw Error(StatusCode::STORAGE, storeName() + ": " + UNREACHABLE + " (" + error.get_error_message() + ")");
    }
    sql << "SET client_min_messages = warning";
    sql << "SET lock_timeout = '5s'";
    sql << "SET client_encoding = 'UTF8'";
    sql << "SET bytea_output = 'hex'";
  }

  std::string beginRead() const override { return "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY"; }
  std::string beginWrite() const override { return "BEGIN"; }
  void lockSchema(soci::session& sql) const override
  {
    // Any number will do, as long as all versions of this store agree on it.
    sql << "SELECT pg_advisory_xact_lock(740215093)";
  }

  std::vector<std::string> tables(soci::session& sql) const override
  {
    soci::rowset<std::string> names = sql.prepare << "SELECT table_name FROM information_schema.tables "
                                                     "WHERE table_schema = current_schema() ORDER BY table_name";
    return { names.begin(), names.end() };
  }

  // SOCI's blob is a PostgreSQL large object, which outlives the row it belongs to; BYTEA goes with its row.
  std::string blobType() const override { return "BYTEA"; }
  std::string blobValue(const std::string& parameter) const override { return parameter; }
  std::string encodeBlob(const std::string& bytes) const override
  {
    std::string text = "\\x";
    text.reserve(2 + 2 * bytes.size());
    for (const char c : bytes)
    {
      text.push_back(HEX_DIGITS[static_cast<unsigned char>(c) >> 4]);
      text.push_back(HEX_DIGITS[static_cast<unsigned char>(c) & 0xf]);
    }
    return text;
  }
  std::string decodeBlob(const std::string& text) const override
  {
    std::string bytes;
    bytes.reserve(text.size() / 2);
    for (std::size_t i = 2; i + 1 < text.size(); i += 2)
      bytes.push_back(static_cast<char>(hexValue(text[i]) << 4 | hexValue(text[i + 1])));
    return bytes;
  }

  Status explain(const soci::soci_error& error) const override
  {
    const std::string state = sqlStateOf(error);
    const std::string state_class = state.substr(0, 2);
    if (state == "53100")
      return { StatusCode::STORAGE, "the server's disk is full; free some space there and try again" };
    if (state == "55P03" || state == "40P01" || state == "40001")
      return { StatusCode::STORAGE, "another client keeps it locked; end that client or try again" };
    if (state == "42501" || state == "25006")
      return { StatusCode::STORAGE, "the database user may not write; grant it the rights on the store's schema" };
    if (state_class == "23")
      return { StatusCode::FAILED_PRECONDITION, "an entry of this id exists already" };
    if (connectionLost(error))
      return { StatusCode::STORAGE, UNREACHABLE };
    return { StatusCode::STORAGE, "unexpected database error" };
  }
  bool connectionLost(const soci::soci_error& error) const override
  {
    const std::string state = sqlStateOf(error);
    // 57P: server shutting down; blank: libpq lost the server before it could answer.
    return error.get_error_category() == soci::soci_error::connection_error || state.substr(0, 3) == "57P" ||
           (!state.empty() && state.find_first_not_of(' ') == std::string::npos);
  }

private:
  std::string connection_, name_;
};
}  // namespace

std::unique_ptr<SqlDialect> makePostgresqlDialect(const std::string& connection)
{
  return std::make_unique<PostgresqlDialect>(connection);
}

}  // namespace object_modelling::keyframes
