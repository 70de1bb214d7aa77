#include <chrono>
#include <filesystem>
#include <thread>

#include <soci/sqlite3/soci-sqlite3.h>

#include "sql_dialect.h"

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::Status;
using base::StatusCode;

constexpr int BUSY_TIMEOUT_MS = 5000;

// Result codes of the SQLite C interface (https://www.sqlite.org/rescode.html); SOCI hides the header's macros.
enum SqliteResult
{
  PERMISSION = 3,
  BUSY = 5,
  LOCKED = 6,
  READ_ONLY = 8,
  IO_ERROR = 10,
  CORRUPT = 11,
  FULL = 13,
  CANNOT_OPEN = 14,
  CONSTRAINT = 19,
  NOT_A_DATABASE = 26,
};

int resultOf(const soci::soci_error& error)
{
  const auto* sqlite_error = dynamic_cast<const soci::sqlite3_soci_error*>(&error);
  return sqlite_error == nullptr ? 0 : sqlite_error->result() & 0xff;
}

class SqliteDialect : public SqlDialect
{
public:
  SqliteDialect(const std::string& path, JournalMode journal_mode) : path_(path), journal_mode_(journal_mode)
  {
    if (path.empty() || path.find('"') != std::string::npos)
      throw Error(StatusCode::INVALID_ARGUMENT, "store path '" + path + "' must not be empty nor hold a double quote");
  }

  std::string storeName() const override { return "store '" + path_ + "'"; }

  void connect(soci::session& sql) const override
  {
    makeFolder();
    sql.open(soci::sqlite3, "dbname=\"" + path_ + "\"");
    sql << "PRAGMA busy_timeout = " << BUSY_TIMEOUT_MS;
    sql << "PRAGMA foreign_keys = ON";
    sql << "PRAGMA synchronous = FULL";  // a commit survives a power cut
    sql << "PRAGMA page_size = 16384";   // images, not small rows; only works before any table
    sql << "PRAGMA auto_vacuum = FULL";  // a deleted session gives its disk space back; only works before any table
    sql << "PRAGMA journal_size_limit = 67108864";
    setJournalMode(sql);
  }

  std::string beginRead() const override { return "BEGIN"; }
  std::string beginWrite() const override { return "BEGIN IMMEDIATE"; }
  void lockSchema(soci::session&) const override {}  // BEGIN IMMEDIATE has done it

  std::vector<std::string> tables(soci::session& sql) const override
  {
    soci::rowset<std::string> names =
        sql.prepare << "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite_%' ORDER BY name";
    return { names.begin(), names.end() };
  }

  std::string blobType() const override { return "BLOB"; }
  std::string blobValue(const std::string& parameter) const override { return "CAST(" + parameter + " AS BLOB)"; }
  std::string encodeBlob(const std::string& bytes) const override { return bytes; }
  std::string decodeBlob(const std::string& text) const override { return text; }

  Status explain(const soci::soci_error& error) const override
  {
    switch (resultOf(error))
    {
      case BUSY:
      case LOCKED:
        return { StatusCode::STORAGE, "another process keeps it locked; end that process or try again" };
      case FULL:
        return { StatusCode::STORAGE, "the disk is full; free some space and try again" };
      case IO_ERROR:
        return { StatusCode::STORAGE, "reading or writing failed; check that the disk is not full and not failing" };
      case PERMISSION:
      case READ_ONLY:
        return { StatusCode::STORAGE, "it is not writable; check the permissions of the file and of its folder" };
      case CANNOT_OPEN:
        return { StatusCode::STORAGE,
                 "it cannot be opened or created; check that the folder exists, is writable and not full" };
      case NOT_A_DATABASE:
        return { StatusCode::BAD_INPUT, "the file is not a SQLite database; give the path of a keyframe store" };
      case CORRUPT:
        return { StatusCode::BAD_INPUT, "the file is damaged; restore it from a copy or from exported sessions" };
      case CONSTRAINT:
        return { StatusCode::FAILED_PRECONDITION, "an entry of this id exists already" };
      default:
        return { StatusCode::STORAGE, "unexpected database error" };
    }
  }
  bool connectionLost(const soci::soci_error&) const override { return false; }

private:
  void makeFolder() const
  {
    const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
    std::error_code failure;
    if (!folder.empty() && !std::filesystem::exists(folder, failure))
      std::filesystem::create_directories(folder, failure);
    if (failure)
      throw Error(StatusCode::STORAGE, storeName() + ": folder '" + folder.string() + "' cannot be created (" +
                                           failure.message() + "); choose a folder that is writable");
  }

  // Changing the mode needs the file for oneself for a moment, and SQLite does not wait for that by itself.
  void setJournalMode(soci::session& sql) const
  {
    const std::string wanted = journal_mode_ == JournalMode::WAL ? "wal" : "delete";
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::milliseconds(BUSY_TIMEOUT_MS);
    while (true)
    {
      try
      {
        std::string mode;
        sql << "PRAGMA journal_mode = " << wanted, soci::into(mode);
        return;  // a file system without shared memory stays with the rollback journal, which is as safe
      }
      catch (const soci::soci_error& error)
      {
        if (resultOf(error) != BUSY || std::chrono::steady_clock::now() > give_up)
          throw;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  std::string path_;
  JournalMode journal_mode_;
};
}  // namespace

std::unique_ptr<SqlDialect> makeSqliteDialect(const std::string& path, JournalMode journal_mode)
{
  return std::make_unique<SqliteDialect>(path, journal_mode);
}

}  // namespace object_modelling::keyframes
