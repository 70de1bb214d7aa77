#include "object_modelling/base/atomic_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "object_modelling/base/status.h"
#include "support/temp_dir.h"

namespace object_modelling::base
{
namespace
{
namespace fs = std::filesystem;
using test_support::TempDir;

std::size_t entries(const std::string& folder)
{
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

/// The error of a call that must fail.
template <typename Call>
Error errorOf(const Call& call)
{
  try
  {
    call();
  }
  catch (const Error& error)
  {
    return error;
  }
  ADD_FAILURE() << "no error";
  return { StatusCode::OK, "" };
}

TEST(AtomicFile, WritesAndReadsBack)
{
  const TempDir dir;
  const std::string text("two\nlines\0and a zero", 20);
  writeTextFile(dir.path("a.txt"), text);
  EXPECT_EQ(readTextFile(dir.path("a.txt")), text);
  writeTextFile(dir.path("a.txt"), "");
  EXPECT_EQ(readTextFile(dir.path("a.txt")), "");
  EXPECT_EQ(entries(dir.path()), 1u);
}

TEST(AtomicFile, LargeTextIsWhole)
{
  const TempDir dir;
  const std::string text(5'000'000, 'x');
  writeTextFile(dir.path("a.txt"), text);
  EXPECT_EQ(readTextFile(dir.path("a.txt")).size(), text.size());
}

TEST(AtomicFile, TemporaryKeepsFolderAndExtension)
{
  const TempDir dir;
  writeFileAtomically(dir.path("mesh.ply"),
                      [&](const std::string& temporary)
                      {
                        EXPECT_EQ(fs::path(temporary).extension(), ".ply");
                        EXPECT_EQ(fs::path(temporary).parent_path(), fs::path(dir.path()));
                        std::ofstream(temporary) << "ply";
                      });
  EXPECT_EQ(readTextFile(dir.path("mesh.ply")), "ply");
}

TEST(AtomicFile, FailingWriterLeavesTheOldFile)
{
  const TempDir dir;
  writeTextFile(dir.path("a.txt"), "old");
  const auto failing = [](const std::string& temporary)
  {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("power cut");
  };
  EXPECT_THROW(writeFileAtomically(dir.path("a.txt"), failing), std::runtime_error);
  EXPECT_EQ(readTextFile(dir.path("a.txt")), "old");
  EXPECT_EQ(entries(dir.path()), 1u);
}

TEST(AtomicFile, WriterThatWritesNothingIsAnError)
{
  const TempDir dir;
  EXPECT_EQ(errorOf([&] { writeFileAtomically(dir.path("a.txt"), [](const std::string&) {}); }).code(),
            StatusCode::STORAGE);
  EXPECT_EQ(entries(dir.path()), 0u);
}

TEST(AtomicFile, MissingFolderNamesPathAndReason)
{
  const TempDir dir;
  const Error error = errorOf([&] { writeTextFile(dir.path("none/a.txt"), "x"); });
  EXPECT_EQ(error.code(), StatusCode::STORAGE);
  EXPECT_NE(std::string(error.what()).find("none"), std::string::npos);
  EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos);
}

TEST(AtomicFile, FolderInTheWayIsAnError)
{
  const TempDir dir;
  fs::create_directory(dir.path("a"));
  EXPECT_EQ(errorOf([&] { writeTextFile(dir.path("a"), "x"); }).code(), StatusCode::STORAGE);
  EXPECT_EQ(errorOf([&] { writeTextFile(dir.path("a/"), "x"); }).code(), StatusCode::STORAGE);
  EXPECT_EQ(errorOf([&] { readTextFile(dir.path("a")); }).code(), StatusCode::STORAGE);
  EXPECT_EQ(entries(dir.path()), 1u);
}

TEST(AtomicFile, FullDiskIsAnErrorAndKeepsTheOldFile)
{
  const TempDir dir;
  writeTextFile(dir.path("a.txt"), "old");
  // A size limit makes write() fail in the middle, as a full disk does.
  struct rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = ::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit limited = { 1000, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limited), 0);
  const Error error = errorOf([&] { writeTextFile(dir.path("a.txt"), std::string(5000, 'x')); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(error.code(), StatusCode::STORAGE);
  EXPECT_NE(std::string(error.what()).find("File too large"), std::string::npos) << error.what();
  EXPECT_EQ(readTextFile(dir.path("a.txt")), "old");
  EXPECT_EQ(entries(dir.path()), 1u);
}

TEST(AtomicFile, MissingFileIsNotFound)
{
  const TempDir dir;
  const Error error = errorOf([&] { readTextFile(dir.path("a.txt")); });
  EXPECT_EQ(error.code(), StatusCode::NOT_FOUND);
  EXPECT_NE(std::string(error.what()).find("a.txt"), std::string::npos);
}

TEST(AtomicFile, RespectsTheUmask)
{
  const TempDir dir;
  const mode_t previous = ::umask(022);
  writeTextFile(dir.path("a.txt"), "x");
  ::umask(previous);
  EXPECT_EQ(fs::status(dir.path("a.txt")).permissions() & fs::perms::mask, fs::perms(0644));
}

TEST(AtomicFile, ReadOnlyFolderIsAnError)
{
  if (::geteuid() == 0)
    GTEST_SKIP() << "root may write everywhere";
  const TempDir dir;
  fs::permissions(dir.path(), fs::perms(0555));
  EXPECT_EQ(errorOf([&] { writeTextFile(dir.path("a.txt"), "x"); }).code(), StatusCode::STORAGE);
  fs::permissions(dir.path(), fs::perms(0755));
}

}  // namespace
}  // namespace object_modelling::base
