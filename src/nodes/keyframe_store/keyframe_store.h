#pragma once

#include <string>

#include <object_modelling/Keyframe.h>
#include <object_modelling/ObjectMask.h>
#include <ros/node_handle.h>

#include "keyframe_store_options.h"
#include "preview_publisher.h"
#include "store_services.h"
#include "watched_store.h"

namespace object_modelling::nodes
{
/// The one owner of session data while the system runs: takes keyframes and masks from topics, serves sessions, shows
/// the current session. One callback thread.
class KeyframeStore : private StoreWatcher
{
public:
  KeyframeStore(ros::NodeHandle& node, ros::NodeHandle& private_node, const KeyframeStoreOptions& options);

private:
  void takeKeyframe(const object_modelling::Keyframe::ConstPtr& message);
  void takeMask(const object_modelling::ObjectMask::ConstPtr& message);

  void onKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe) override;
  void onPoses(const std::string& session_id, const std::vector<keyframes::PoseUpdate>& updates) override;
  void onMasks(const std::string& session_id, const std::vector<keyframes::MaskUpdate>& updates) override;
  void onDeleted(const std::string& session_id) override;
  void onWrite(const base::Status& status) override;

  /// Turns the previews to a session, with what is stored of it. False if they show it already.
  bool turnPreviewTo(const std::string& session_id);
  void publishState(const base::Status& status);
  void publishPreview();

  KeyframeStoreOptions options_;
  std::string connection_;
  SessionPreview preview_;
  PreviewPublisher preview_publisher_;
  bool preview_changed_ = false;
  WatchedStore store_;
  int refused_count_ = 0;
  ros::Publisher state_;
  ros::Subscriber keyframes_, masks_;
  ros::WallTimer preview_timer_;
  StoreServices services_;
};

}  // namespace object_modelling::nodes
