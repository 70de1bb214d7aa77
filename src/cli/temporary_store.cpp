#include "temporary_store.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <glog/logging.h>

namespace object_modelling::cli
{
namespace
{
std::string makeFolder()
{
  std::error_code error;
  const std::string root = std::filesystem::temp_directory_path(error).string();
  std::string folder = root + "/object_modelling_XXXXXX";
  if (error || !mkdtemp(folder.data()))
    throw base::Error(base::StatusCode::STORAGE, "cannot make a temporary folder in '" + root +
                                                     "': " + (error ? error.message() : std::strerror(errno)) +
                                                     "; set TMPDIR to a folder with space");
  return folder;
}
}  // namespace

TemporaryStore::TemporaryStore() : folder_(makeFolder()), store_(keyframes::openSqlStore(folder_ + "/keyframes.sqlite"))
{
}

TemporaryStore::~TemporaryStore()
{
  store_.reset();
  std::error_code error;
  std::filesystem::remove_all(folder_, error);
  LOG_IF(WARNING, static_cast<bool>(error)) << "temporary folder '" << folder_ << "' stays: " << error.message();
}

}  // namespace object_modelling::cli
