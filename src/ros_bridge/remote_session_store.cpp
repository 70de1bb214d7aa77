#include "object_modelling/ros_bridge/remote_session_store.h"

#include <object_modelling/AddKeyframe.h>
#include <object_modelling/ChangeSession.h>
#include <object_modelling/CreateSession.h>
#include <object_modelling/DeleteSession.h>
#include <object_modelling/ExportSession.h>
#include <object_modelling/GetAlignments.h>
#include <object_modelling/GetEncodedKeyframe.h>
#include <object_modelling/GetSession.h>
#include <object_modelling/ImportSession.h>
#include <object_modelling/ListSessions.h>
#include <object_modelling/UpdateAlignments.h>
#include <ros/service.h>

#include "object_modelling/base/options.h"
#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/names.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/session_conversion.h"
#include "object_modelling/ros_bridge/status_conversion.h"
#include "object_modelling/ros_bridge/timed_call.h"

namespace object_modelling::ros_bridge
{
std::vector<std::string> RemoteSessionStoreOptions::violations() const
{
  base::OptionsCheck check("remote_session_store");
  check.require("node", !node.empty(), "must name the keyframe store's node");
  check.positive("connect_timeout_s", connect_timeout_s);
  check.positive("call_timeout_s", call_timeout_s);
  return check.violations();
}

RemoteSessionStore::RemoteSessionStore(const ros::NodeHandle& node, const RemoteSessionStoreOptions& options)
    : node_(node), options_(base::checked(options))
{
}

bool RemoteSessionStore::available() const
{
  return ros::service::exists(node_.resolveName(options_.node + "/" + names::LIST_SESSIONS), false);
}

template <typename Service>
void RemoteSessionStore::call(const char* name, Service& service, ros::ServiceClient* kept)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const CallLimits limits = { options_.connect_timeout_s, options_.call_timeout_s };
  const std::string relative = options_.node + "/" + name;
  if (!kept)
    return callInTime(node_, relative, limits, service);
  // A kept connection may be to a store that has gone: it only reads, so that asking again does no harm.
  const std::string resolved = node_.resolveName(relative);
  if (!kept->isValid() || !answered(resolved, *kept, limits.answer_s, service))
  {
    *kept = connected<Service>(node_, resolved, limits.wait_s);
    if (!answered(resolved, *kept, limits.answer_s, service))
    {
      throwIfShuttingDown();
      throw notAnswering("service '" + resolved + "'", "it went away during the call");
    }
  }
  throwUnlessOk(service.response.status);
}

void RemoteSessionStore::createSession(const keyframes::Session& session)
{
  object_modelling::CreateSession service;
  service.request.session = toMessage(session);
  call(names::CREATE_SESSION, service);
}

std::vector<keyframes::Session> RemoteSessionStore::listSessions()
{
  object_modelling::ListSessions service;
  call(names::LIST_SESSIONS, service);
  std::vector<keyframes::Session> sessions;
  for (const object_modelling::Session& session : service.response.sessions)
    sessions.push_back(fromMessage(session));
  return sessions;
}

keyframes::Session RemoteSessionStore::session(const std::string& session_id)
{
  object_modelling::GetSession service;
  service.request.session_id = session_id;
  call(names::GET_SESSION, service);
  return fromMessage(service.response.session);
}

void RemoteSessionStore::update(const std::string& session_id, const keyframes::SessionChange& change)
{
  object_modelling::ChangeSession service;
  service.request.session_id = session_id;
  service.request.change = toMessage(change);
  call(names::CHANGE_SESSION, service);
}

void RemoteSessionStore::deleteSession(const std::string& session_id)
{
  object_modelling::DeleteSession service;
  service.request.session_id = session_id;
  call(names::DELETE_SESSION, service);
}

void RemoteSessionStore::addKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe)
{
  object_modelling::AddKeyframe service;
  service.request.keyframe = toMessage(keyframe, session_id, std::string());
  call(names::ADD_KEYFRAME, service);
}

std::vector<int> RemoteSessionStore::keyframeIds(const std::string& session_id)
{
  object_modelling::GetSession service;
  service.request.session_id = session_id;
  call(names::GET_SESSION, service);
  return { service.response.keyframe_ids.begin(), service.response.keyframe_ids.end() };
}

keyframes::EncodedKeyframe RemoteSessionStore::encodedKeyframe(const std::string& session_id, int keyframe_id)
{
  object_modelling::GetEncodedKeyframe service;
  service.request.session_id = session_id;
  service.request.keyframe_id = keyframe_id;
  call(names::GET_ENCODED_KEYFRAME, service, &keyframe_client_);
  return fromMessage(service.response.keyframe);
}

std::vector<keyframes::AlignmentRecord> RemoteSessionStore::alignments()
{
  object_modelling::GetAlignments service;
  call(names::GET_ALIGNMENTS, service);
  std::vector<keyframes::AlignmentRecord> records;
  for (const object_modelling::AlignmentRecord& record : service.response.alignments)
    records.push_back(fromMessage(record));
  return records;
}

void RemoteSessionStore::updateAlignments(const std::vector<keyframes::AlignmentRecord>& records)
{
  object_modelling::UpdateAlignments service;
  for (const keyframes::AlignmentRecord& record : records)
    service.request.alignments.push_back(toMessage(record));
  call(names::UPDATE_ALIGNMENTS, service);
}

void RemoteSessionStore::exportSession(const std::string& session_id, const std::string& path)
{
  object_modelling::ExportSession service;
  service.request.session_id = session_id;
  service.request.path = path;
  call(names::EXPORT_SESSION, service);
}

std::string RemoteSessionStore::importSession(const std::string& path)
{
  object_modelling::ImportSession service;
  service.request.path = path;
  call(names::IMPORT_SESSION, service);
  return service.response.session_id;
}

}  // namespace object_modelling::ros_bridge
