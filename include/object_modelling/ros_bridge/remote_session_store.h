#pragma once

#include <mutex>
#include <string>

#include <ros/node_handle.h>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::ros_bridge
{
struct RemoteSessionStoreOptions
{
  std::string node = "keyframe_store";  ///< name of the store's node, relative to the node handle
  double connect_timeout_s = 5;         ///< how long to wait for a service that is not there
  double call_timeout_s = 60;           ///< how long one call may take
  std::vector<std::string> violations() const;
};

/// The keyframe_store node as a SessionStore. Errors of the store arrive as the base::Error that it threw; a store that
/// cannot be reached or does not answer in time is a TIMEOUT that names the service. A restarted store is
/// found again. Safe for several threads (calls are serialised); needs no spinning of the caller.
class RemoteSessionStore : public keyframes::SessionStore
{
public:
  RemoteSessionStore(const ros::NodeHandle& node, const RemoteSessionStoreOptions& options = {});

  /// Whether the store answers at all, without waiting.
  bool available() const;

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
  /// Throws the error of the response's status, if any. `kept`: a connection for many calls that only read; else one
  /// for this.
  template <typename Service>
  void call(const char* name, Service& service, ros::ServiceClient* kept = nullptr);

  ros::NodeHandle node_;
  RemoteSessionStoreOptions options_;
  std::mutex mutex_;
  ros::ServiceClient keyframe_client_;  ///< a session has many keyframes
};

}  // namespace object_modelling::ros_bridge
