#include "alignment_sessions.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/pipeline/session_refinement.h"
#include "object_modelling/source/tum_folder.h"

namespace object_modelling::benchmark_alignment
{
namespace
{
namespace fs = std::filesystem;

fs::path cleaned(const std::string& folder)
{
  return fs::absolute(folder + "/").lexically_normal().parent_path();
}

void require(const std::string& stage, const base::Status& status)
{
  if (!status.ok())
    throw base::Error(status.code, stage + ": " + status.message);
}

/// With what SQLite keeps beside it.
void removeStore(const std::string& path)
{
  for (const char* suffix : { "", "-wal", "-shm" })
    fs::remove(path + suffix);
}

/// Default options but for the camera's noise model, as those of the command are.
void makeSession(const std::string& folder, const std::string& id, const std::string& path,
                 const rgbd::SensorNoiseModel& noise_model)
{
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(path);
  const std::unique_ptr<source::FrameSource> source = source::openTumFolder(folder);
  keyframes::Session session;
  session.id = id;
  session.object_id = objectFolderOf(folder);
  base::JobControl control;
  pipeline::RecordOptions options;
  options.frame.noise_model = noise_model;
  pipeline::recordSession(*source, session, store.get(), options, control);
  require("refinement", pipeline::refineSessionBy(*store, id, {}, control).status);
  require("segmentation", pipeline::segmentStoredSession(*store, id, std::nullopt, {}, control).status);
}

/// A file appears under its own name only when it is whole, but another program may have put it there.
bool isComplete(const std::string& path, const std::string& id)
{
  if (!fs::exists(path))
    return false;
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(path);
  const std::vector<keyframes::Session> sessions = store->listSessions();
  return std::any_of(sessions.begin(), sessions.end(),
                     [&](const keyframes::Session& session)
                     { return session.id == id && session.closed && session.keyframe_count > 0; });
}
}  // namespace

std::string sessionIdOf(const std::string& folder)
{
  return objectFolderOf(folder) + "." + cleaned(folder).filename().string();
}

std::string objectFolderOf(const std::string& folder)
{
  return cleaned(folder).parent_path().filename().string();
}

StoredSession storedSession(const std::string& folder, const std::string& cache,
                            const rgbd::SensorNoiseModel& noise_model)
{
  const std::string id = sessionIdOf(folder);
  const std::string path = (fs::path(cache) / (id + ".sqlite")).string(), unfinished = path + ".unfinished";
  StoredSession stored;
  if (!isComplete(path, id))
  {
    const auto start = std::chrono::steady_clock::now();
    fs::create_directories(cache);
    removeStore(unfinished);
    try
    {
      makeSession(folder, id, unfinished, noise_model);
    }
    catch (const base::Error&)
    {
      removeStore(unfinished);
      throw;
    }
    removeStore(path);
    fs::rename(unfinished, path);
    stored.made_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  const std::unique_ptr<keyframes::SessionStore> store = keyframes::openSqlStore(path);
  stored.session = store->session(id);
  stored.keyframes = keyframes::loadKeyframes(*store, id);
  return stored;
}

}  // namespace object_modelling::benchmark_alignment
