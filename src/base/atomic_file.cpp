#include "object_modelling/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "object_modelling/base/status.h"

namespace object_modelling::base
{
namespace
{
namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& action, const std::string& path, int error)
{
  throw Error(StatusCode::STORAGE, "cannot " + action + " " + path + ": " + std::system_category().message(error));
}

class FileDescriptor
{
public:
  FileDescriptor(const std::string& path, int flags, int mode = 0) : fd_(::open(path.c_str(), flags | O_CLOEXEC, mode))
  {
  }
  ~FileDescriptor()
  {
    if (fd_ >= 0)
      ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return fd_; }

private:
  int fd_;
};

std::string folderOf(const std::string& path)
{
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::string temporaryFor(const std::string& path)
{
  static std::atomic<unsigned> count{ 0 };
  const std::string prefix = ".writing-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + "-";
  return (fs::path(folderOf(path)) / (prefix + fs::path(path).filename().string())).string();
}

void writeAll(const std::string& path, const std::string& text)
{
  const FileDescriptor file(path, O_WRONLY | O_CREAT | O_EXCL, 0666);
  if (file.get() < 0)
    fail("create", path, errno);
  for (std::size_t done = 0; done < text.size();)
  {
    const ssize_t written = ::write(file.get(), text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR)
      fail("write", path, errno);
    done += written > 0 ? static_cast<std::size_t>(written) : 0;
  }
}

}  // namespace

void syncToDisk(const std::string& path)
{
  const FileDescriptor file(path, O_RDONLY);
  if (file.get() < 0)
    fail("open", path, errno);
  // Some file systems cannot sync a folder (EINVAL); the rename is then as safe as they make it.
  if (::fsync(file.get()) != 0 && errno != EINVAL)
    fail("flush", path, errno);
}

void writeFileAtomically(const std::string& path, const std::function<void(const std::string&)>& write)
{
  if (fs::path(path).filename().empty())
    throw Error(StatusCode::STORAGE, "cannot write " + path + ": the path names no file");
  const std::string temporary = temporaryFor(path);
  try
  {
    write(temporary);
    syncToDisk(temporary);
    if (std::rename(temporary.c_str(), path.c_str()) != 0)
      fail("replace", path, errno);
  }
  catch (...)
  {
    std::remove(temporary.c_str());
    throw;
  }
  syncToDisk(folderOf(path));
}

void writeTextFile(const std::string& path, const std::string& text)
{
  writeFileAtomically(path, [&](const std::string& temporary) { writeAll(temporary, text); });
}

std::string readTextFile(const std::string& path)
{
  const FileDescriptor file(path, O_RDONLY);
  if (file.get() < 0 && errno == ENOENT)
    throw Error(StatusCode::NOT_FOUND, "there is no file " + path);
  if (file.get() < 0)
    fail("open", path, errno);
  std::string text;
  char buffer[1 << 16];
  for (;;)
  {
    const ssize_t count = ::read(file.get(), buffer, sizeof(buffer));
    if (count < 0 && errno != EINTR)
      fail("read", path, errno);
    if (count == 0)
      return text;
    text.append(buffer, count > 0 ? static_cast<std::size_t>(count) : 0);
  }
}

}  // namespace object_modelling::base
