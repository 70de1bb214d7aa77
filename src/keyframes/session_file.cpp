#include "session_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "object_modelling/base/atomic_file.h"
#include "store_rows.h"
#include "store_schema.h"

namespace object_modelling::keyframes
{
namespace
{
namespace fs = std::filesystem;
using base::Error;
using base::StatusCode;

/// A folder that disappears with the object.
class ScratchFolder
{
public:
  ScratchFolder(const fs::path& parent, const std::string& remedy)
  {
    std::string name = (parent / ".object_modelling-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw Error(StatusCode::STORAGE,
                  "no file can be made in folder '" + parent.string() + "' (" + std::strerror(errno) + "); " + remedy);
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder()
  {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

private:
  fs::path path_;
};

void copySession(soci::session& from, const SqlDialect& from_dialect, soci::session& to, const SqlDialect& to_dialect,
                 const Session& session)
{
  insertSession(to, session);
  for (const int id : selectKeyframeIds(from, session.id))
    insertKeyframe(to, to_dialect, session.id, selectKeyframe(from, from_dialect, session.id, id));
}

Session onlySession(soci::session& sql, const std::string& path)
{
  const std::vector<Session> sessions = selectSessions(sql);
  if (sessions.size() != 1)
    throw Error(StatusCode::BAD_INPUT, "'" + path + "' holds " + std::to_string(sessions.size()) +
                                           " sessions instead of one; import takes files that export has written");
  if (!isValidId(sessions.front().id))
    throw Error(StatusCode::BAD_INPUT, "'" + path +
                                           "' names its session in a way that this store does not take; "
                                           "export it again");
  return sessions.front();
}

void checkImages(soci::session& sql, const SqlDialect& dialect, const std::string& session_id, const std::string& path)
{
  for (const int id : selectKeyframeIds(sql, session_id))
    decodeKeyframe(selectKeyframe(sql, dialect, session_id, id),
                   "keyframe " + std::to_string(id) + " in '" + path + "'");
}
}  // namespace

void writeSessionFile(SqlConnection& store, const std::string& session_id, const std::string& path)
{
  if (!fs::path(path).has_filename())
    throw Error(StatusCode::INVALID_ARGUMENT, "'" + path + "' is no file name; give a path such as /data/session.db");
  const fs::path target = fs::absolute(path);
  if (fs::exists(target))
    throw Error(StatusCode::FAILED_PRECONDITION,
                "'" + path + "' exists already; choose another name or remove it first");
  const ScratchFolder scratch(target.parent_path(), "choose a folder that exists and is writable");
  const fs::path file = scratch.path() / "session.db";
  const std::string subject = "exporting session '" + session_id + "' to '" + path + "'";
  {
    SqlConnection exported(makeSqliteDialect(file.string(), JournalMode::ROLLBACK));
    migrate(exported, storeMigrations());
    store.read(subject,
               [&](soci::session& from)
               {
                 const Session session = selectSession(from, session_id);
                 exported.write(subject, [&](soci::session& to)
                                { copySession(from, store.dialect(), to, exported.dialect(), session); });
               });
  }
  std::error_code failure;
  fs::rename(file, target, failure);
  if (failure)
    throw Error(StatusCode::STORAGE, subject + ": " + failure.message() + "; choose a folder that is writable");
  base::syncToDisk(target.parent_path().string());
}

std::string readSessionFile(SqlConnection& store, const std::string& path)
{
  if (!fs::is_regular_file(path))
    throw Error(StatusCode::NOT_FOUND, "'" + path + "' is not a file; give the path of an exported session");
  // A copy, because a file of an older schema is brought up to date before it is read.
  const ScratchFolder scratch(fs::temp_directory_path(), "set TMPDIR to a writable folder with enough space");
  const fs::path file = scratch.path() / "session.db";
  std::error_code failure;
  fs::copy_file(path, file, failure);
  if (!failure)
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write, failure);
  if (failure)
    throw Error(StatusCode::STORAGE, "'" + path + "' cannot be copied to '" + scratch.path().string() + "' (" +
                                         failure.message() + "); set TMPDIR to a writable folder with enough space");
  if (fs::file_size(file) == 0)
    throw Error(StatusCode::BAD_INPUT, "'" + path + "' is empty; give the path of an exported session");

  SqlConnection imported(makeSqliteDialect(file.string(), JournalMode::ROLLBACK));
  migrate(imported, storeMigrations());
  const std::string subject = "importing '" + path + "'";
  std::string session_id;
  imported.read(subject,
                [&](soci::session& from)
                {
                  const Session session = onlySession(from, path);
                  session_id = session.id;
                  checkImages(from, imported.dialect(), session.id, path);
                  store.write(subject, [&](soci::session& to)
                              { copySession(from, imported.dialect(), to, store.dialect(), session); });
                });
  return session_id;
}

}  // namespace object_modelling::keyframes
