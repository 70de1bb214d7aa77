#pragma once

#include <string>
#include <vector>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::pipeline
{
/// Where a session goes while it is recorded. Throws base::Error as a store does.
class SessionSink
{
public:
  virtual ~SessionSink() = default;

  virtual void create(const keyframes::Session& session) = 0;
  /// The keyframes of a stored session that is to go on; NO_RESULT if it has none, FAILED_PRECONDITION if it was
  /// recorded with another noise model. Changes nothing.
  virtual std::vector<rgbd::Keyframe> stored(const std::string& session_id,
                                             const rgbd::SensorNoiseModel& noise_model) = 0;
  /// Opens a stored session again: what was made of its keyframes so far does not hold for those to come.
  virtual void reopen(const std::string& session_id) = 0;
  virtual void add(const std::string& session_id, const rgbd::Keyframe& keyframe,
                   const std::string& camera_frame_id) = 0;
  /// The recording has ended; `keyframe_count`: all that the session should have now. May wait for them.
  virtual void close(const std::string& session_id, int keyframe_count) = 0;
  /// The recording broke off. Throws nothing.
  virtual void discard(const std::string& session_id) noexcept = 0;
};

/// Commits to a store at once; a session that broke off is deleted again.
class StoreSink : public SessionSink
{
public:
  /// `store` must outlive this.
  explicit StoreSink(keyframes::SessionStore& store) : store_(store) {}

  void create(const keyframes::Session& session) override;
  std::vector<rgbd::Keyframe> stored(const std::string& session_id, const rgbd::SensorNoiseModel& noise_model) override;
  void reopen(const std::string& session_id) override;
  void add(const std::string& session_id, const rgbd::Keyframe& keyframe, const std::string& camera_frame_id) override;
  void close(const std::string& session_id, int keyframe_count) override;
  void discard(const std::string& session_id) noexcept override;

private:
  keyframes::SessionStore& store_;
};

}  // namespace object_modelling::pipeline
