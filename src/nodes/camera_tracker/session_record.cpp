#include "session_record.h"

#include <chrono>
#include <thread>
#include <utility>

namespace object_modelling::nodes
{
namespace
{
constexpr std::chrono::milliseconds POLL_PERIOD(50);
}

SessionRecord::SessionRecord(Publish publish, keyframes::SessionStore* store, double stored_timeout_s)
    : publish_(std::move(publish)), store_(store), stored_timeout_s_(stored_timeout_s)
{
}

bool SessionRecord::has(const std::string& session_id)
{
  if (store_ == nullptr)
    return false;
  try
  {
    store_->session(session_id);
    return true;
  }
  catch (const base::Error& error)
  {
    if (error.code() == base::StatusCode::NOT_FOUND)
      return false;
    throw;
  }
}

void SessionRecord::requireFree(const std::string& session_id)
{
  if (has(session_id))
    throw base::Error(
        base::StatusCode::FAILED_PRECONDITION,
        "session '" + session_id + "' is in the store already; choose another id, or set resume to continue it");
}

std::string SessionRecord::freeId(const std::string& session_id)
{
  std::string id = session_id;
  for (int n = 2; has(id); ++n)
    id = session_id + "_" + std::to_string(n);
  return id;
}

void SessionRecord::create(const keyframes::Session& session)
{
  if (store_ != nullptr)
    pipeline::StoreSink(*store_).create(session);
}

std::vector<rgbd::Keyframe> SessionRecord::stored(const std::string& session_id,
                                                  const rgbd::SensorNoiseModel& noise_model)
{
  if (store_ == nullptr)
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "session '" + session_id + "' is in no store");
  return pipeline::StoreSink(*store_).stored(session_id, noise_model);
}

void SessionRecord::reopen(const std::string& session_id)
{
  pipeline::StoreSink(*store_).reopen(session_id);
}

void SessionRecord::add(const std::string& session_id, const rgbd::Keyframe& keyframe,
                        const std::string& camera_frame_id)
{
  publish_(keyframe, session_id, camera_frame_id);
}

void SessionRecord::close(const std::string& session_id, int keyframe_count)
{
  if (store_ == nullptr)
    return;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(stored_timeout_s_);
  int stored_count = store_->session(session_id).keyframe_count;
  while (stored_count < keyframe_count && std::chrono::steady_clock::now() < deadline)
  {
    std::this_thread::sleep_for(POLL_PERIOD);
    stored_count = store_->session(session_id).keyframe_count;
  }
  pipeline::StoreSink(*store_).close(session_id, stored_count);
  if (stored_count < keyframe_count)
    throw base::Error(base::StatusCode::STORAGE, "the keyframe store has " + std::to_string(stored_count) + " of the " +
                                                     std::to_string(keyframe_count) + " keyframes of session '" +
                                                     session_id + "'; its ~state and log say why");
}

}  // namespace object_modelling::nodes
