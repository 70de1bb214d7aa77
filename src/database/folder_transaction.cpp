#include "folder_transaction.h"

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <thread>

#include "content_hash.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"
#include "object_yaml.h"

namespace object_modelling::database
{
namespace
{
namespace fs = std::filesystem;
using base::Error;
using base::StatusCode;

// Hidden names, which no object id can have. A parked folder is the former state of an object while the new one takes
// its place; a removed one is to disappear.
const std::string TEMPORARY_PREFIX = ".object_modelling-";
const std::string NEW = TEMPORARY_PREFIX + "new-";
const std::string PARKED = TEMPORARY_PREFIX + "parked-";
const std::string REMOVED = TEMPORARY_PREFIX + "removed-";
const std::string NEXT_MANIFEST = TEMPORARY_PREFIX + "manifest.yaml";
constexpr auto LOCK_TIMEOUT = std::chrono::seconds(10);

bool startsWith(const std::string& text, const std::string& prefix)
{
  return text.compare(0, prefix.size(), prefix) == 0;
}

[[noreturn]] void fail(const std::string& action, const std::string& path, int error)
{
  throw Error(StatusCode::STORAGE, "cannot " + action + " " + path + ": " + std::system_category().message(error) +
                                       "; check that the folder is writable and the disk has space");
}

void rename(const std::string& from, const std::string& to)
{
  if (std::rename(from.c_str(), to.c_str()) != 0)
    fail("put in place", to, errno);
}

/// By system call: the C library has a function for it only since glibc 2.28.
bool exchange(const std::string& a, const std::string& b)
{
  return syscall(SYS_renameat2, AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

void prepareManifest(const std::string& root, const std::map<std::string, ListedObject>& objects)
{
  writeManifest(root + "/" + NEXT_MANIFEST, objects);
}

void publishManifest(const std::string& root)
{
  base::syncToDisk(root);  // the folders before the manifest that speaks of them
  rename(root + "/" + NEXT_MANIFEST, manifestPath(root));
  base::syncToDisk(root);
}

/// The manifest's entry for the object in a folder.
ListedObject listedFrom(const std::string& folder)
{
  ListedObject listed{ hashOfFile(folder + "/object.yaml"), false };
  try
  {
    listed.partial = readObject(folder).entry.partial;
  }
  catch (const Error&)
  {
    // Not to be read: check() names it.
  }
  return listed;
}

/// After an interrupted change, marked by a prepared manifest: the folders' state becomes the manifest's.
void reconcileManifest(const std::string& root)
{
  if (!fs::exists(root + "/" + NEXT_MANIFEST))
    return;
  std::map<std::string, ListedObject> objects = readManifest(manifestPath(root)).objects;
  for (const auto& [id, listed] : readManifest(root + "/" + NEXT_MANIFEST).objects)
    objects[id] = listed;
  for (auto object = objects.begin(); object != objects.end();)
  {
    const std::string folder = root + "/" + object->first;
    if (!fs::exists(folder + "/object.yaml"))
    {
      object = objects.erase(object);
      continue;
    }
    object->second = listedFrom(folder);
    ++object;
  }
  writeManifest(manifestPath(root), objects);
}
}  // namespace

WriterLock::WriterLock(const std::string& root, const base::JobControl& control)
    : descriptor_(open((root + "/.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666))
{
  if (descriptor_ < 0)
    fail("open", root + "/.lock", errno);
  const auto give_up = std::chrono::steady_clock::now() + LOCK_TIMEOUT;
  while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
  {
    const bool cancelled = control.cancelled();
    if (cancelled || std::chrono::steady_clock::now() > give_up)
    {
      close(descriptor_);
      if (cancelled)
        throw base::Cancelled();
      throw Error(StatusCode::STORAGE, "object database " + root +
                                           " is being written by another process; wait until "
                                           "it has finished and try again");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

WriterLock::~WriterLock()
{
  close(descriptor_);
}

std::string makeTemporaryFolder(const std::string& root, const std::string& object_id)
{
  std::string folder = root + "/" + NEW + object_id;
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure)
    fail("make folder", folder, failure.value());
  return folder;
}

void syncFolder(const std::string& folder)
{
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    base::syncToDisk(entry.path().string());
  base::syncToDisk(folder);
}

void replaceFolder(const std::string& replacement, const std::string& target, const std::string& parked,
                   bool can_exchange)
{
  if (!fs::exists(target))
    return rename(replacement, target);
  if (can_exchange && exchange(replacement, target))
    return rename(replacement, parked);
  rename(target, parked);
  try
  {
    rename(replacement, target);
  }
  catch (const Error&)
  {
    rename(parked, target);
    throw;
  }
}

void commitObject(const std::string& root, const std::string& object_id, const ListedObject& listed)
{
  const std::string replacement = root + "/" + NEW + object_id;
  const std::string target = root + "/" + object_id;
  const std::string parked = root + "/" + PARKED + object_id;
  std::map<std::string, ListedObject> objects = readManifest(manifestPath(root)).objects;
  objects[object_id] = listed;
  prepareManifest(root, objects);
  replaceFolder(replacement, target, parked);
  try
  {
    publishManifest(root);
  }
  catch (const Error&)
  {
    rename(target, replacement);
    if (fs::exists(parked))
      rename(parked, target);
    throw;
  }
}

void commitRemoval(const std::string& root, const std::string& object_id)
{
  const std::string target = root + "/" + object_id;
  const std::string removed = root + "/" + REMOVED + object_id;
  std::map<std::string, ListedObject> objects = readManifest(manifestPath(root)).objects;
  objects.erase(object_id);
  prepareManifest(root, objects);
  rename(target, removed);
  try
  {
    publishManifest(root);
  }
  catch (const Error&)
  {
    rename(removed, target);
    throw;
  }
}

void recover(const std::string& root)
{
  for (const fs::directory_entry& entry : fs::directory_iterator(root))
  {
    const std::string name = entry.path().filename().string();
    if (startsWith(name, PARKED) && !fs::exists(root + "/" + name.substr(PARKED.size())))
      rename(entry.path().string(), root + "/" + name.substr(PARKED.size()));
  }
  reconcileManifest(root);
  removeTemporaries(root);
}

void removeTemporaries(const std::string& root)
{
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(root, ignored))
    if (startsWith(entry.path().filename().string(), TEMPORARY_PREFIX))
      fs::remove_all(entry.path(), ignored);
}

}  // namespace object_modelling::database
