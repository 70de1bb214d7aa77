#pragma once

#include <string>
#include <vector>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::nodes
{
/// The tracker's side of a session in the keyframe store. Throws base::Error as the store does. Not thread safe.
class SessionRecord
{
public:
  /// `store` must outlive this.
  SessionRecord(keyframes::SessionStore& store, double stored_timeout_s);

  /// FAILED_PRECONDITION if the store has a session of this id.
  void requireFree(const std::string& session_id);
  /// `session_id`, or that with _2, _3, ... if it is taken.
  std::string freeId(const std::string& session_id);

  void create(const keyframes::Session& session) { store_.createSession(session); }
  /// Opens a stored session again and gives its keyframes; NO_RESULT if it has none, FAILED_PRECONDITION if it was
  /// recorded with another noise model.
  std::vector<rgbd::Keyframe> reopen(const std::string& session_id, const rgbd::SensorNoiseModel& noise_model);
  /// Waits until the store has as many keyframes as were sent, then closes the session. STORAGE if some never arrive.
  void finish(const std::string& session_id, int sent_keyframe_count);

private:
  bool has(const std::string& session_id);

  keyframes::SessionStore& store_;
  double stored_timeout_s_;
};

}  // namespace object_modelling::nodes
