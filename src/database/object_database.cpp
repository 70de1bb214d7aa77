#include "object_modelling/database/object_database.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <glog/logging.h>

#include "content_hash.h"
#include "folder_transaction.h"
#include "manifest.h"
#include "object_files.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/keyframes/session.h"
#include "object_revision.h"
#include "object_yaml.h"
#include "yaml_text.h"

namespace object_modelling::database
{
namespace
{
namespace fs = std::filesystem;
using base::Error;
using base::StatusCode;

void createFolder(const std::string& root)
{
  std::error_code failure;
  fs::create_directories(root, failure);
  if (!failure && faccessat(AT_FDCWD, root.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    failure.assign(errno, std::system_category());
  if (failure)
    throw Error(StatusCode::STORAGE, "object database " + root + " cannot be written: " + failure.message() +
                                         "; choose a folder that is writable");
}

bool hasManifest(const std::string& root)
{
  std::error_code failure;
  const bool found = fs::exists(manifestPath(root), failure);
  if (failure)
    throw Error(StatusCode::STORAGE,
                "object database " + root + " cannot be read: " + failure.message() + "; check its permissions");
  return found;
}

Error notFound(const std::string& root, const std::string& object_id)
{
  return { StatusCode::NOT_FOUND,
           "object '" + object_id + "' is not in the object database " + root + "; list the objects to see which are" };
}

/// Whatever happens, no temporary stays behind.
class Cleanup
{
public:
  explicit Cleanup(std::string root) : root_(std::move(root)) {}
  ~Cleanup() { removeTemporaries(root_); }
  Cleanup(const Cleanup&) = delete;
  Cleanup& operator=(const Cleanup&) = delete;

private:
  std::string root_;
};

/// Runs a change of the database; every failure leaves as base::Error that names database and object.
template <typename Change>
void change(const std::string& root, const std::string& object_id, const base::JobControl& control, const Change& body)
{
  const auto explain = [&](const std::string& cause)
  { return "object '" + object_id + "' in database " + root + " stays as it was: " + cause; };
  try
  {
    const WriterLock lock(root, control);
    recover(root);
    const Cleanup cleanup(root);
    body();
  }
  catch (const base::Cancelled&)
  {
    throw;
  }
  catch (const Error& error)
  {
    throw Error(error.code(), explain(error.what()));
  }
  catch (const fs::filesystem_error& error)
  {
    throw Error(StatusCode::STORAGE,
                explain(std::string(error.what()) + "; check that it is writable and the disk has space"));
  }
}
}  // namespace

void checkObjectId(const std::string& object_id)
{
  if (!keyframes::isValidId(object_id) || object_id == "exports" || object_id == "manifest.yaml")
    throw Error(StatusCode::INVALID_ARGUMENT, "'" + object_id.substr(0, 80) +
                                                  "' is no object id: 1 to 64 of A-Z a-z 0-9 _ . - are, not starting "
                                                  "with '.' or '-', except 'exports' and 'manifest.yaml'");
}

ObjectDatabase::ObjectDatabase(const std::string& root, bool create) : root_(fs::absolute(root).lexically_normal())
{
  while (root_.size() > 1 && root_.back() == '/')
    root_.pop_back();
  if (create)
  {
    createFolder(root_);
    const base::JobControl control;
    if (!hasManifest(root_))
    {
      const WriterLock lock(root_, control);
      if (!hasManifest(root_))
        writeManifest(manifestPath(root_), {});
    }
  }
  if (!hasManifest(root_))
    throw Error(StatusCode::NOT_FOUND, root_ + " is no object database: it has no manifest.yaml");
  readManifest(manifestPath(root_));
}

std::vector<ObjectEntry> ObjectDatabase::list() const
{
  std::vector<ObjectEntry> entries;
  for (const auto& [id, listed] : readManifest(manifestPath(root_)).objects)
  {
    try
    {
      entries.push_back(readObject(root_ + "/" + id).entry);
    }
    catch (const Error& error)
    {
      // One broken object must not hide the others; check() names it.
      LOG(WARNING) << "object '" << id << "' of " << root_ << " is left out: " << error.what();
    }
  }
  return entries;
}

ObjectEntry ObjectDatabase::entry(const std::string& object_id) const
{
  checkObjectId(object_id);
  if (readManifest(manifestPath(root_)).objects.count(object_id) == 0)
    throw notFound(root_, object_id);
  return readObject(root_ + "/" + object_id).entry;
}

std::map<std::string, std::string> ObjectDatabase::contentHashes() const
{
  std::map<std::string, std::string> hashes;
  for (const auto& [id, listed] : readManifest(manifestPath(root_)).objects)
    hashes[id] = listed.content_hash;
  return hashes;
}

std::string ObjectDatabase::write(const ObjectModel& model, base::JobControl& control, const ReportMaker& make_report)
{
  checkModel(model);
  change(root_, model.id, control,
         [&]
         {
           const std::string folder = makeTemporaryFolder(root_, model.id);
           writeObjectFiles(folder, model, control);
           const std::string description = objectYaml(model, hashesOfFolder(folder));
           base::writeTextFile(folder + "/object.yaml", description);
           if (make_report)
             make_report(folder);
           sealReport(folder);
           syncFolder(folder);
           control.checkCancelled();
           commitObject(root_, model.id, { hashOfText(description), !model.sessions_left_out.empty() });
         });
  return root_ + "/" + model.id;
}

void ObjectDatabase::remakeReport(const std::string& object_id, base::JobControl& control,
                                  const ReportMaker& make_report)
{
  checkObjectId(object_id);
  change(root_, object_id, control,
         [&]
         {
           if (readManifest(manifestPath(root_)).objects.count(object_id) == 0)
             throw notFound(root_, object_id);
           make_report(root_ + "/" + object_id);
           sealReport(root_ + "/" + object_id);
         });
}

std::string ObjectDatabase::derivedPath(const std::string& root, const std::string& object_id, const std::string& name)
{
  return root + "/" + object_id + "/recognition/" + name;
}

bool ObjectDatabase::keepDerived(const std::string& object_id, const std::string& content_hash, const std::string& name,
                                 const std::function<void(const std::string& path)>& write,
                                 const base::JobControl& control)
{
  checkObjectId(object_id);
  bool kept = false;
  change(root_, object_id, control,
         [&]
         {
           const Manifest manifest = readManifest(manifestPath(root_));
           const auto listed = manifest.objects.find(object_id);
           if (listed == manifest.objects.end() || listed->second.content_hash != content_hash)
             return;
           const std::string path = derivedPath(root_, object_id, name);
           fs::create_directories(fs::path(path).parent_path());
           base::writeFileAtomically(path, write);
           kept = true;
         });
  return kept;
}

void ObjectDatabase::remove(const std::string& object_id)
{
  checkObjectId(object_id);
  const base::JobControl control;
  change(root_, object_id, control,
         [&]
         {
           if (readManifest(manifestPath(root_)).objects.count(object_id) == 0)
             throw notFound(root_, object_id);
           commitRemoval(root_, object_id);
         });
}

void ObjectDatabase::rename(const std::string& object_id, const std::string& new_id, const ReportMaker& make_report)
{
  checkObjectId(object_id);
  checkObjectId(new_id);
  const base::JobControl control;
  change(root_, object_id, control,
         [&]
         {
           const Manifest manifest = readManifest(manifestPath(root_));
           const auto listed = manifest.objects.find(object_id);
           if (listed == manifest.objects.end())
             throw notFound(root_, object_id);
           if (manifest.objects.count(new_id) > 0)
             throw Error(StatusCode::INVALID_ARGUMENT, "there is an object '" + new_id + "' already");
           const std::string folder = makeTemporaryFolder(root_, new_id);
           const std::string text = copyRenamed(root_ + "/" + object_id, folder, object_id, new_id);
           if (make_report)
           {
             make_report(folder);
             sealReport(folder);
           }
           syncFolder(folder);
           // In this order: a crash between leaves both.
           commitObject(root_, new_id, { hashOfText(text), listed->second.partial });
           commitRemoval(root_, object_id);
         });
}

void ObjectDatabase::absorb(const std::string& object_id, const std::string& absorbed_id,
                            const std::string& absorbed_hash)
{
  checkObjectId(object_id);
  checkObjectId(absorbed_id);
  const base::JobControl control;
  change(root_, absorbed_id, control,
         [&]
         {
           const Manifest manifest = readManifest(manifestPath(root_));
           for (const std::string& id : { object_id, absorbed_id })
             if (manifest.objects.count(id) == 0)
               throw notFound(root_, id);
           if (manifest.objects.at(absorbed_id).content_hash != absorbed_hash)
             throw Error(StatusCode::FAILED_PRECONDITION,
                         "it has been changed meanwhile, and '" + object_id + "' was not made of that; try again");
           const std::string folder = makeTemporaryFolder(root_, object_id);
           const std::string text = copyWithAliases(root_ + "/" + object_id, folder,
                                                    aliasesWith(root_ + "/" + object_id, root_ + "/" + absorbed_id));
           syncFolder(folder);
           // In this order: a crash between leaves both.
           commitObject(root_, object_id, { hashOfText(text), manifest.objects.at(object_id).partial });
           commitRemoval(root_, absorbed_id);
         });
}

bool ObjectDatabase::migrate(const std::string& object_id, base::JobControl& control)
{
  if (entry(object_id).schema_version >= SCHEMA_VERSION)
    return false;
  change(root_, object_id, control,
         [&]
         {
           const Manifest manifest = readManifest(manifestPath(root_));
           const auto listed = manifest.objects.find(object_id);
           if (listed == manifest.objects.end())
             throw notFound(root_, object_id);
           const std::string folder = makeTemporaryFolder(root_, object_id);
           const std::string text = copyMigrated(root_ + "/" + object_id, folder, control);
           syncFolder(folder);
           control.checkCancelled();
           commitObject(root_, object_id, { hashOfText(text), listed->second.partial });
         });
  return true;
}

}  // namespace object_modelling::database
