#pragma once

#include <functional>
#include <memory>
#include <string>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::nodes
{
/// Told of every write to the store, after it.
class StoreWatcher
{
public:
  virtual ~StoreWatcher() = default;
  virtual void onKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe) = 0;
  virtual void onPoses(const std::string& session_id, const std::vector<keyframes::PoseUpdate>& updates) = 0;
  virtual void onMasks(const std::string& session_id, const std::vector<keyframes::MaskUpdate>& updates) = 0;
  virtual void onDeleted(const std::string& session_id) = 0;
  /// After any write, good or refused, and after the ones above.
  virtual void onWrite(const base::Status& status) = 0;
};

/// The SQL store, opened when first needed and again after a failure, so that a node outlives a store that cannot be
/// opened and every call reports the reason. Not thread safe.
class WatchedStore : public keyframes::SessionStore
{
public:
  /// `watcher` must outlive this.
  WatchedStore(const std::string& connection, StoreWatcher& watcher);

  void createSession(const keyframes::Session& session) override;
  std::vector<keyframes::Session> listSessions() override;
  keyframes::Session session(const std::string& session_id) override;
  void update(const std::string& session_id, const keyframes::SessionChange& change) override;
  void deleteSession(const std::string& session_id) override;

  void addKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe) override;
  std::vector<int> keyframeIds(const std::string& session_id) override;
  keyframes::EncodedKeyframe encodedKeyframe(const std::string& session_id, int keyframe_id) override;

  std::vector<keyframes::AlignmentRecord> alignments() override;
  void updateAlignments(const std::vector<keyframes::AlignmentRecord>& records) override;

  void exportSession(const std::string& session_id, const std::string& path) override;
  std::string importSession(const std::string& path) override;

private:
  keyframes::SessionStore& opened();
  /// `tell` is called once the data is stored; what it throws does not undo that and is logged.
  void write(const std::function<void(keyframes::SessionStore&)>& body, const std::function<void()>& tell = {});

  std::string connection_;
  StoreWatcher& watcher_;
  std::unique_ptr<keyframes::SessionStore> store_;
};

}  // namespace object_modelling::nodes
