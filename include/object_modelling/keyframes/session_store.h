#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "object_modelling/base/status.h"
#include "object_modelling/keyframes/alignment_record.h"
#include "object_modelling/keyframes/encoded_keyframe.h"
#include "object_modelling/keyframes/session.h"
#include "object_modelling/keyframes/session_change.h"
#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::keyframes
{
/// Owner of session data. Implemented over SQL (openSqlStore) and, in ros_bridge, over the keyframe_store node's
/// services; every stage takes this interface. Every call is one transaction: done whole or not at all.
/// All calls throw base::Error: NOT_FOUND (session, keyframe), INVALID_ARGUMENT (id, size), FAILED_PRECONDITION (exists
/// already, keyframe id taken), STORAGE (full disk, locked, newer schema), always naming session and remedy.
class SessionStore
{
public:
  virtual ~SessionStore() = default;

  virtual void createSession(const Session& session) = 0;
  virtual std::vector<Session> listSessions() = 0;  ///< oldest first
  virtual Session session(const std::string& session_id) = 0;
  /// Writes what the change sets, poses and masks too: all or nothing.
  virtual void update(const std::string& session_id, const SessionChange& change) = 0;
  virtual void deleteSession(const std::string& session_id) = 0;

  /// Sets the session's started_s too if this is its first keyframe and started_s is 0. Depth is kept to within half of
  /// 0.1 mm (1 mm if any reading is beyond 6.5 m; beyond 65.5 m counts as missing), everything else exactly.
  virtual void addKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe) = 0;
  virtual std::vector<int> keyframeIds(const std::string& session_id) = 0;  ///< ascending
  /// Pose and calibration are of one time.
  virtual EncodedKeyframe encodedKeyframe(const std::string& session_id, int keyframe_id) = 0;
  /// The same, decoded().
  rgbd::Keyframe keyframe(const std::string& session_id, int keyframe_id)
  {
    return decoded(encodedKeyframe(session_id, keyframe_id), session_id);
  }

  /// How sessions lie to each other, as far as that is known; ordered by their ids.
  virtual std::vector<AlignmentRecord> alignments() = 0;
  /// Replaces what is known of these pairs; one without findings is forgotten. A session takes its own with it when it
  /// is deleted.
  virtual void updateAlignments(const std::vector<AlignmentRecord>& records) = 0;

  /// One session as a store file of its own (SQLite, whatever the backend), and back under its own id. Neither replaces
  /// what is there: FAILED_PRECONDITION if the file, or on import the session, exists.
  virtual void exportSession(const std::string& session_id, const std::string& path) = 0;
  virtual std::string importSession(const std::string& path) = 0;
};

/// All keyframes of a session, ascending; each is decoded while the next one is fetched. `progress` gets the number
/// of keyframes loaded and their total, and may throw.
std::vector<rgbd::Keyframe> loadKeyframes(SessionStore& store, const std::string& session_id,
                                          const std::function<void(std::size_t, std::size_t)>& progress = {});

/// Opens or creates a store, and brings one of an older schema up to date. `connection`: path of a SQLite file (WAL;
/// its folder is made if missing), or "postgresql://user@host:port/database" or "postgresql://host=... dbname=...".
/// Throws base::Error: STORAGE (newer schema, not writable, server not reachable), BAD_INPUT (some other file).
/// Safe for several threads (calls are serialised) and, on SQLite, several processes.
std::unique_ptr<SessionStore> openSqlStore(const std::string& connection);

}  // namespace object_modelling::keyframes
