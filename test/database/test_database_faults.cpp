#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "../../src/database/folder_transaction.h"
#include "../../src/database/manifest.h"
#include "model_fixtures.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/database/object_database.h"
#include "support/temp_dir.h"

namespace object_modelling::database
{
namespace fs = std::filesystem;
using base::StatusCode;

namespace
{
constexpr uid_t NOBODY = 65534;

void writeModel(const std::string& root, const ObjectModel& model)
{
  base::JobControl control;
  ObjectDatabase(root, true).write(model, control);
}

/// Neither manifest nor object nor any temporary differs.
void expectUnchanged(const std::string& root, std::map<std::string, std::string> before)
{
  std::map<std::string, std::string> after = contentsOf(root);
  before.erase(".lock");
  after.erase(".lock");
  EXPECT_EQ(after.size(), before.size());
  EXPECT_TRUE(after == before);
  EXPECT_TRUE(ObjectDatabase(root, false).check().empty());
}
}  // namespace

TEST(DatabaseFaults, SaysThatTheFolderIsNotWritable)
{
  const test_support::TempDir folder;
  const std::string root = folder.path("db");
  writeModel(root, makeModel("cereal", 0, 0));
  const ObjectDatabase open(root, true);
  const fs::perms readable_by_all = fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read |
                                    fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec;
  fs::permissions(folder.path(), readable_by_all | fs::perms::owner_write);
  fs::permissions(root, readable_by_all);
  const bool root_user = geteuid() == 0;
  // The real user as well: AT_EACCESS of glibc before 2.33 asks for that one.
  ASSERT_TRUE(!root_user || setresuid(NOBODY, NOBODY, 0) == 0);
  const base::Status reopened = statusOf([&] { ObjectDatabase(root, true); });
  const base::Status written = statusOf([&] { writeModel(root, makeModel("cereal", 1, 0)); });
  const std::size_t readable = ObjectDatabase(root, false).list().size();
  ASSERT_TRUE(!root_user || setresuid(0, 0, 0) == 0);
  fs::permissions(root, fs::perms::owner_all);
  EXPECT_EQ(readable, 1u);
  for (const base::Status& status : { reopened, written })
  {
    EXPECT_EQ(status.code, StatusCode::STORAGE);
    EXPECT_TRUE(mentions(status, root) && mentions(status, "writable")) << status.message;
  }
}

TEST(DatabaseFaults, RefusesAFileInPlaceOfTheFolder)
{
  const test_support::TempDir folder;
  base::writeTextFile(folder.path("db"), "");
  EXPECT_EQ(statusOf([&] { ObjectDatabase(folder.path("db"), true); }).code, StatusCode::STORAGE);
}

TEST(DatabaseFaults, AFullDiskLeavesTheOldObject)
{
  const test_support::TempDir folder;
  if (geteuid() != 0 || mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=20m") != 0)
    GTEST_SKIP() << "a small file system can only be mounted by root; the file size limit stands in for it";
  const std::string root = folder.path("db");
  writeModel(root, makeModel("cereal", 0, 1));
  const std::map<std::string, std::string> before = contentsOf(root);
  const base::Status status = statusOf([&] { writeModel(root, makeModel("cereal", 1, 12)); });
  EXPECT_EQ(status.code, StatusCode::STORAGE);
  EXPECT_TRUE(mentions(status, root) && mentions(status, "space")) << status.message;
  expectUnchanged(root, before);
  writeModel(root, makeModel("cereal", 1, 1));
  EXPECT_TRUE(ObjectDatabase(root, false).check().empty());
  umount2(folder.path().c_str(), MNT_DETACH);
}

TEST(DatabaseFaults, AFileSizeLimitLeavesTheOldObject)
{
  const test_support::TempDir folder;
  const std::string root = folder.path("db");
  writeModel(root, makeModel("cereal", 0, 1));
  const std::map<std::string, std::string> before = contentsOf(root);
  rlimit unlimited{};
  getrlimit(RLIMIT_FSIZE, &unlimited);
  rlimit limit = unlimited;
  limit.rlim_cur = 100 << 10;
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  const base::Status status = statusOf([&] { writeModel(root, makeModel("cereal", 1, 2)); });
  setrlimit(RLIMIT_FSIZE, &unlimited);
  signal(SIGXFSZ, handler);
  EXPECT_EQ(status.code, StatusCode::STORAGE) << status.message;
  expectUnchanged(root, before);
}

TEST(DatabaseFaults, AKilledWriterLeavesOneWholeObject)
{
  const test_support::TempDir folder;
  const std::string root = folder.path("db");
  const ObjectModel original = makeModel("cereal", 0, 1);
  writeModel(root, original);
  const ObjectModel replacement = makeModel("cereal", 1, 3);
  for (int round = 0; round < 8; ++round)
  {
    const pid_t child = fork();
    if (child == 0)
    {
      writeModel(root, replacement);
      _exit(0);
    }
    usleep(static_cast<useconds_t>(20000 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::string name = ObjectDatabase(root, false).entry("cereal").name;
    ASSERT_TRUE(name == original.name || name == replacement.name) << "round " << round;
    writeModel(root, makeModel("cup", 0, 0));  // the next writer cleans up
    EXPECT_TRUE(ObjectDatabase(root, false).check().empty()) << "round " << round;
    for (const fs::directory_entry& entry : fs::directory_iterator(root))
      EXPECT_NE(entry.path().filename().string().rfind(".object_modelling", 0), 0u) << entry.path();
  }
}

TEST(DatabaseFaults, MendsEveryPointOfACrash)
{
  const test_support::TempDir folder;
  const std::string root = folder.path("db"), elsewhere = folder.path("elsewhere");
  writeModel(elsewhere, makeModel("cereal", 1, 0));
  const auto restart = [&]
  {
    fs::remove_all(root);
    writeModel(root, makeModel("cereal", 0, 0));
  };
  const std::string added = root + "/.object_modelling-new-cereal", parked = root + "/.object_modelling-parked-cereal",
                    removed = root + "/.object_modelling-removed-cereal",
                    next = root + "/.object_modelling-manifest.yaml", object = root + "/cereal";
  const auto mended = [&](std::size_t objects)
  {
    writeModel(root, makeModel("other", 0, 0));
    const ObjectDatabase database(root, false);
    return database.check().empty() && database.list().size() == objects + 1 && !fs::exists(added) &&
           !fs::exists(parked) && !fs::exists(removed) && !fs::exists(next);
  };
  const auto copyNew = [&](const std::string& to) { fs::copy(elsewhere + "/cereal", to, fs::copy_options::recursive); };

  restart();  // while the new object was being made
  fs::create_directory(added);
  EXPECT_TRUE(mended(1));
  restart();  // after the new manifest, before the exchange
  copyNew(added);
  fs::copy_file(manifestPath(elsewhere), next);
  EXPECT_TRUE(mended(1));
  restart();  // after the exchange
  fs::rename(object, added);
  copyNew(object);
  fs::copy_file(manifestPath(elsewhere), next);
  EXPECT_TRUE(mended(1));
  restart();  // after the old object was parked, where folders cannot be exchanged
  fs::rename(object, parked);
  copyNew(added);
  fs::copy_file(manifestPath(elsewhere), next);
  EXPECT_TRUE(mended(1));
  restart();  // before the parked object was removed
  fs::rename(object, parked);
  copyNew(object);
  fs::copy_file(manifestPath(elsewhere), manifestPath(root), fs::copy_options::overwrite_existing);
  EXPECT_TRUE(mended(1));
  restart();  // in the middle of a removal
  fs::rename(object, removed);
  writeManifest(next, {});
  EXPECT_TRUE(mended(0));
}

TEST(DatabaseFaults, FoldersAreReplacedWithAndWithoutExchange)
{
  for (const bool can_exchange : { true, false })
  {
    const test_support::TempDir folder;
    const std::string target = folder.path("target"), fresh = folder.path("fresh"), parked = folder.path("parked");
    fs::create_directory(target);
    fs::create_directory(fresh);
    base::writeTextFile(target + "/old", "");
    base::writeTextFile(fresh + "/new", "");
    replaceFolder(fresh, target, parked, can_exchange);
    EXPECT_TRUE(fs::exists(target + "/new"));
    EXPECT_TRUE(fs::exists(parked + "/old"));
    EXPECT_FALSE(fs::exists(fresh));
  }
}

TEST(DatabaseFaults, WritersTakeTurns)
{
  const test_support::TempDir folder;
  const std::string root = folder.path("db");
  ObjectDatabase(root, true);
  std::vector<std::thread> writers;
  for (int i = 0; i < 4; ++i)
    writers.emplace_back([&, i] { writeModel(root, makeModel("object_" + std::to_string(i % 3), i, 1)); });
  for (std::thread& writer : writers)
    writer.join();
  EXPECT_EQ(ObjectDatabase(root, false).list().size(), 3u);
  EXPECT_TRUE(ObjectDatabase(root, false).check().empty());
}

TEST(DatabaseFaults, AWaitingWriterCanBeCancelled)
{
  const test_support::TempDir folder;
  const std::string root = folder.path("db");
  ObjectDatabase database(root, true);
  base::JobControl control;
  const WriterLock held(root, control);
  std::thread canceller(
      [&]
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        control.cancel();
      });
  EXPECT_EQ(statusOf([&] { database.write(makeModel("cereal", 0, 0), control); }).code, StatusCode::CANCELLED);
  canceller.join();
}

}  // namespace object_modelling::database
