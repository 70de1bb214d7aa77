#pragma once

#include <functional>
#include <string>
#include <vector>

#include "object_modelling/pipeline/session_sink.h"

namespace object_modelling::nodes
{
/// The tracker's side of a session: its record goes to the keyframe store, if there is one, and keyframes to the topic
/// that the store takes them from. What is stored stays. Throws base::Error as the store does. Not thread safe.
class SessionRecord : public pipeline::SessionSink
{
public:
  using Publish = std::function<void(const rgbd::Keyframe& keyframe, const std::string& session_id,
                                     const std::string& camera_frame_id)>;

  /// `store` may be null: then keyframes are only published. It must outlive this.
  SessionRecord(Publish publish, keyframes::SessionStore* store, double stored_timeout_s);

  bool stores() const { return store_ != nullptr; }
  /// FAILED_PRECONDITION if the store has a session of this id.
  void requireFree(const std::string& session_id);
  /// `session_id`, or that with _2, _3, ... if it is taken.
  std::string freeId(const std::string& session_id);

  void create(const keyframes::Session& session) override;
  /// INVALID_ARGUMENT without a store.
  std::vector<rgbd::Keyframe> stored(const std::string& session_id, const rgbd::SensorNoiseModel& noise_model) override;
  void reopen(const std::string& session_id) override;
  void add(const std::string& session_id, const rgbd::Keyframe& keyframe, const std::string& camera_frame_id) override;
  /// Waits until the store has as many keyframes as were sent, then closes the session. STORAGE if some never arrive.
  void close(const std::string& session_id, int keyframe_count) override;
  void discard(const std::string&) noexcept override {}

private:
  bool has(const std::string& session_id);

  Publish publish_;
  keyframes::SessionStore* store_;
  double stored_timeout_s_;
};

}  // namespace object_modelling::nodes
