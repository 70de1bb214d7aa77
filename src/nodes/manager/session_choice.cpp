#include "session_choice.h"

#include <algorithm>
#include <set>

#include "../jobs/session_list.h"

namespace object_modelling::nodes
{
namespace
{
using keyframes::Session;

void refuseRepeated(const std::vector<std::string>& session_ids)
{
  std::set<std::string> seen, repeated;
  for (const std::string& id : session_ids)
    if (!seen.insert(id).second)
      repeated.insert(id);
  if (!repeated.empty())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "sessions named twice: " + joined({ repeated.begin(), repeated.end() }));
}

std::vector<Session> named(keyframes::SessionStore& store, const std::vector<std::string>& session_ids)
{
  refuseRepeated(session_ids);
  std::vector<Session> sessions;
  for (const std::string& id : session_ids)
    sessions.push_back(store.session(id));
  return sessions;
}

std::vector<Session> sessionsOf(keyframes::SessionStore& store, const std::string& object_id,
                                const std::string& last_session_id)
{
  std::vector<Session> own, last;
  std::vector<std::string> stored;
  for (const Session& session : store.listSessions())
  {
    stored.push_back(session.id);
    if (session.object_id == object_id)
      own.push_back(session);
    else if (session.object_id.empty() && session.id == last_session_id)
      last.push_back(session);
  }
  const std::vector<Session>& chosen = own.empty() ? last : own;
  if (chosen.empty())
    throw base::Error(base::StatusCode::NOT_FOUND, "object '" + object_id +
                                                       "' has no session: record one with start_session and "
                                                       "stop_session, or name the sessions (stored: " +
                                                       (stored.empty() ? "none" : joined(stored)) + ")");
  return chosen;
}
}  // namespace

void checkId(const std::string& what, const std::string& value)
{
  if (!keyframes::isValidId(value))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      what + " '" + value + "' must have 1 to 64 of [A-Za-z0-9_.-] and not begin with '.' or '-'");
}

std::vector<std::string> chooseSessions(keyframes::SessionStore& store, const std::string& object_id,
                                        const std::vector<std::string>& asked_for, const std::string& last_session_id)
{
  std::vector<std::string> ids;
  for (const Session& session :
       asked_for.empty() ? sessionsOf(store, object_id, last_session_id) : named(store, asked_for))
  {
    if (session.keyframe_count == 0)
      throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                        "session '" + session.id +
                            "' has no keyframes: record it again with the object "
                            "in view, or discard_session");
    ids.push_back(session.id);
  }
  return ids;
}

}  // namespace object_modelling::nodes
