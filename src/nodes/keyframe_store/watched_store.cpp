#include "watched_store.h"

#include <glog/logging.h>

#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
WatchedStore::WatchedStore(const std::string& connection, StoreWatcher& watcher)
    : connection_(connection), watcher_(watcher)
{
}

keyframes::SessionStore& WatchedStore::opened()
{
  if (!store_)
    store_ = keyframes::openSqlStore(connection_);
  return *store_;
}

void WatchedStore::write(const std::function<void(keyframes::SessionStore&)>& body, const std::function<void()>& tell)
{
  const base::Status status = ros_bridge::guarded([&] { body(opened()); });
  if (status.ok() && tell)
  {
    const base::Status told = ros_bridge::guarded(tell);
    LOG_IF(WARNING, !told.ok()) << "the preview does not show the last change: " << told.message;
  }
  watcher_.onWrite(status);
  if (!status.ok())
    throw base::Error(status.code, status.message);
}

void WatchedStore::createSession(const keyframes::Session& session)
{
  write([&](keyframes::SessionStore& store) { store.createSession(session); });
}

std::vector<keyframes::Session> WatchedStore::listSessions()
{
  return opened().listSessions();
}

keyframes::Session WatchedStore::session(const std::string& session_id)
{
  return opened().session(session_id);
}

void WatchedStore::update(const std::string& session_id, const keyframes::SessionChange& change)
{
  write([&](keyframes::SessionStore& store) { store.update(session_id, change); },
        [&]
        {
          if (!change.poses.empty())
            watcher_.onPoses(session_id, change.poses);
          if (!change.masks.empty())
            watcher_.onMasks(session_id, change.masks);
        });
}

void WatchedStore::deleteSession(const std::string& session_id)
{
  write([&](keyframes::SessionStore& store) { store.deleteSession(session_id); },
        [&] { watcher_.onDeleted(session_id); });
}

void WatchedStore::addKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe)
{
  write([&](keyframes::SessionStore& store) { store.addKeyframe(session_id, keyframe); },
        [&] { watcher_.onKeyframe(session_id, keyframe); });
}

std::vector<int> WatchedStore::keyframeIds(const std::string& session_id)
{
  return opened().keyframeIds(session_id);
}

keyframes::EncodedKeyframe WatchedStore::encodedKeyframe(const std::string& session_id, int keyframe_id)
{
  return opened().encodedKeyframe(session_id, keyframe_id);
}

std::vector<keyframes::AlignmentRecord> WatchedStore::alignments()
{
  return opened().alignments();
}

void WatchedStore::updateAlignments(const std::vector<keyframes::AlignmentRecord>& records)
{
  write([&](keyframes::SessionStore& store) { store.updateAlignments(records); });
}

void WatchedStore::exportSession(const std::string& session_id, const std::string& path)
{
  opened().exportSession(session_id, path);
}

std::string WatchedStore::importSession(const std::string& path)
{
  std::string session_id;
  write([&](keyframes::SessionStore& store) { session_id = store.importSession(path); });
  return session_id;
}

}  // namespace object_modelling::nodes
