#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "../../src/keyframes/sql_connection.h"
#include "postgresql_server.h"
#include "store_fixtures.h"

namespace object_modelling::keyframes
{
namespace fs = std::filesystem;
using base::StatusCode;
using test_support::mentions;

namespace
{
constexpr uid_t NOBODY = 65534;

/// Root may write everywhere; permissions only mean something to somebody else.
class AsNobody
{
public:
  AsNobody() : was_root_(geteuid() == 0) { changed_ = was_root_ && seteuid(NOBODY) == 0; }
  ~AsNobody()
  {
    if (changed_ && seteuid(0) != 0)
      std::abort();
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;

private:
  bool was_root_, changed_ = false;
};
}  // namespace

TEST(StoreFaults, MakesAMissingFolder)
{
  const TemporaryFolder folder;
  openSqlStore(folder.path("a b=c/d/store.db"))->createSession(makeSession("a"));
  EXPECT_TRUE(fs::exists(folder.path("a b=c/d/store.db")));
}

TEST(StoreFaults, RefusesPathsThatCannotBeStores)
{
  const TemporaryFolder folder;
  EXPECT_EQ(statusOf([&] { openSqlStore(""); }).code, StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(statusOf([&] { openSqlStore(folder.path("a\" x=\"b")); }).code, StatusCode::INVALID_ARGUMENT);
  const base::Status status = statusOf([&] { openSqlStore(folder.path()); });
  EXPECT_EQ(status.code, StatusCode::STORAGE);
  EXPECT_TRUE(mentions(status, folder.path())) << status.message;
}

TEST(StoreFaults, RefusesAFileThatIsNotSqlite)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("notes.txt")) << std::string(10000, 'x');
  const base::Status status = statusOf([&] { openSqlStore(folder.path("notes.txt")); });
  EXPECT_EQ(status.code, StatusCode::BAD_INPUT);
  EXPECT_TRUE(mentions(status, "notes.txt") && mentions(status, "not a SQLite database")) << status.message;
  EXPECT_EQ(fs::file_size(folder.path("notes.txt")), 10000u);
}

TEST(StoreFaults, SaysThatAFolderIsNotWritable)
{
  const TemporaryFolder folder;
  openSqlStore(folder.path("store.db"))->createSession(makeSession("a"));
  fs::permissions(folder.path(),
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  fs::permissions(folder.path("store.db"), fs::perms::owner_read | fs::perms::others_read);
  base::Status add, create, make_folder;
  {
    const AsNobody nobody;
    add = statusOf([&] { openSqlStore(folder.path("store.db"))->addKeyframe("a", makeKeyframe(0)); });
    create = statusOf([&] { openSqlStore(folder.path("new.db")); });
    make_folder = statusOf([&] { openSqlStore(folder.path("new/new.db")); });
  }
  fs::permissions(folder.path(), fs::perms::all);
  for (const base::Status& status : { add, create, make_folder })
  {
    EXPECT_EQ(status.code, StatusCode::STORAGE) << status.message;
    EXPECT_TRUE(mentions(status, folder.path()) && mentions(status, "writable")) << status.message;
  }
}

TEST(StoreFaults, ReportsALockedFileAndGoesOn)
{
  const TemporaryFolder folder;
  const std::unique_ptr<SessionStore> store = openSqlStore(folder.path("store.db"));
  store->createSession(makeSession("a"));
  SqlConnection other(makeSqliteDialect(folder.path("store.db"), JournalMode::WAL));
  base::Status status;
  other.write("test", [&](soci::session&) { status = statusOf([&] { store->addKeyframe("a", makeKeyframe(0)); }); });
  EXPECT_EQ(status.code, StatusCode::STORAGE);
  EXPECT_TRUE(mentions(status, "session 'a'") && mentions(status, "another process")) << status.message;
  EXPECT_TRUE(store->keyframeIds("a").empty());
  store->addKeyframe("a", makeKeyframe(0));
  EXPECT_EQ(store->keyframeIds("a").size(), 1u);
}

TEST(StoreFaults, WaitsForAShortLock)
{
  const TemporaryFolder folder;
  const std::unique_ptr<SessionStore> store = openSqlStore(folder.path("store.db"));
  store->createSession(makeSession("a"));
  SqlConnection other(makeSqliteDialect(folder.path("store.db"), JournalMode::WAL));
  std::thread writer;
  other.write("test",
              [&](soci::session&)
              {
                writer = std::thread([&] { store->addKeyframe("a", makeKeyframe(0)); });
                std::this_thread::sleep_for(std::chrono::milliseconds(300));
              });
  writer.join();
  EXPECT_EQ(store->keyframeIds("a").size(), 1u);
}

/// Fills up a store until it fails; then all that was accepted must be there, and room made usable.
void fillAndRecover(const std::string& path, const std::function<void()>& make_room)
{
  const std::unique_ptr<SessionStore> store = openSqlStore(path);
  store->createSession(makeSession("a"));
  int accepted = 0;
  base::Status status;
  while (status.ok() && accepted < 500)
  {
    status = statusOf([&] { store->addKeyframe("a", makeKeyframe(accepted, 320, 240)); });
    accepted += status.ok();
  }
  EXPECT_EQ(status.code, StatusCode::STORAGE) << status.message;
  EXPECT_TRUE(mentions(status, "full") && mentions(status, path)) << status.message;
  EXPECT_LT(status.message.size(), 500u);  // no image data in the message
  EXPECT_EQ(store->keyframeIds("a").size(), static_cast<std::size_t>(accepted));
  ASSERT_GT(accepted, 0);
  expectSame(store->keyframe("a", accepted - 1), makeKeyframe(accepted - 1, 320, 240));
  make_room();
  store->addKeyframe("a", makeKeyframe(accepted, 320, 240));
  expectSame(openSqlStore(path)->keyframe("a", accepted), makeKeyframe(accepted, 320, 240));
}

TEST(StoreFaults, SurvivesAFullDisk)
{
  const TemporaryFolder folder;
  if (geteuid() != 0 || mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=8m") != 0)
    GTEST_SKIP() << "a small file system can only be mounted by root; the file size limit stands in for it";
  fillAndRecover(folder.path("store.db"), [&] { mount("", folder.path().c_str(), "", MS_REMOUNT, "size=32m"); });
  umount2(folder.path().c_str(), MNT_DETACH);
}

TEST(StoreFaults, SurvivesAFileSizeLimit)
{
  const TemporaryFolder folder;
  rlimit unlimited{};
  getrlimit(RLIMIT_FSIZE, &unlimited);
  rlimit limit = unlimited;
  limit.rlim_cur = 4 << 20;
  const auto before = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  fillAndRecover(folder.path("store.db"), [&] { setrlimit(RLIMIT_FSIZE, &unlimited); });
  setrlimit(RLIMIT_FSIZE, &unlimited);
  signal(SIGXFSZ, before);
}

TEST(StoreFaults, GivesTheSpaceOfADeletedSessionBack)
{
  const TemporaryFolder folder;
  const std::unique_ptr<SessionStore> store = openSqlStore(folder.path("store.db"));
  store->createSession(makeSession("a"));
  for (int id = 0; id < 10; ++id)
    store->addKeyframe("a", makeKeyframe(id, 320, 240));
  store->deleteSession("a");
  const std::unique_ptr<SessionStore> other = openSqlStore(folder.path("store.db"));
  other->createSession(makeSession("b"));
  EXPECT_LT(fs::file_size(folder.path("store.db")), 100000u);
}

TEST(StoreFaults, KeepsCommittedKeyframesWhenKilled)
{
  const TemporaryFolder folder;
  const std::string path = folder.path("store.db");
  openSqlStore(path)->createSession(makeSession("a"));
  int committed_total = 0;
  for (int round = 0; round < 5; ++round)
  {
    int channel[2];
    ASSERT_EQ(pipe(channel), 0);
    const pid_t child = fork();
    if (child == 0)
    {
      const std::unique_ptr<SessionStore> store = openSqlStore(path);
      for (int id = committed_total;; ++id)
      {
        store->addKeyframe("a", makeKeyframe(id, 320, 240));
        if (write(channel[1], &id, sizeof(id)) != sizeof(id))
          _exit(1);
      }
    }
    close(channel[1]);
    // The kill comes at another point of a write in every round.
    int id = 0;
    for (int i = 0; i < 2 + round; ++i)
      ASSERT_EQ(read(channel[0], &id, sizeof(id)), static_cast<ssize_t>(sizeof(id)));
    usleep(static_cast<useconds_t>(1700 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    while (read(channel[0], &id, sizeof(id)) == static_cast<ssize_t>(sizeof(id)))
      continue;
    close(channel[0]);

    const std::unique_ptr<SessionStore> store = openSqlStore(path);
    const std::vector<int> ids = store->keyframeIds("a");
    ASSERT_GT(static_cast<int>(ids.size()), id);      // all that were reported,
    ASSERT_LE(static_cast<int>(ids.size()), id + 2);  // at most the one that was being reported besides,
    for (const int stored : ids)                      // and all whole
      expectSame(store->keyframe("a", stored), makeKeyframe(stored, 320, 240));
    committed_total = static_cast<int>(ids.size());
  }
}

TEST(StoreFaults, ReconnectsToAServerThatWasAway)
{
  PostgresqlServer* server = PostgresqlServer::shared();
  if (server == nullptr)
    GTEST_SKIP() << "PostgreSQL's server is not installed (package postgresql)";
  const std::unique_ptr<SessionStore> store = openSqlStore(server->createDatabase());
  store->createSession(makeSession("a"));
  server->stop();
  for (int attempt = 0; attempt < 2; ++attempt)
  {
    const base::Status status = statusOf([&] { store->addKeyframe("a", makeKeyframe(0)); });
    EXPECT_EQ(status.code, StatusCode::STORAGE);
    EXPECT_TRUE(mentions(status, "server cannot be reached")) << status.message;
  }
  server->start();
  store->addKeyframe("a", makeKeyframe(0));
  EXPECT_EQ(store->keyframeIds("a").size(), 1u);
}

TEST(StoreFaults, NeverShowsAPassword)
{
  for (const char* connection :
       { "postgresql://host=/nowhere dbname=x user=u password=s3cret", "postgresql://u:s3cret@127.0.0.1:1/x",
         "postgresql://host=/nowhere password='s3cret with space'" })
  {
    const base::Status status = statusOf([&] { openSqlStore(connection); });
    EXPECT_EQ(status.code, StatusCode::STORAGE);
    EXPECT_TRUE(mentions(status, "server cannot be reached")) << status.message;
    EXPECT_FALSE(mentions(status, "s3cret")) << status.message;
  }
}

}  // namespace object_modelling::keyframes
