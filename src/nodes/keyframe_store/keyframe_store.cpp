#include "keyframe_store.h"

#include <object_modelling/StoreState.h>

#include "../common/data_path.h"
#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/names.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
namespace names = ros_bridge::names;

/// A tracker makes a few keyframes a second; none may be lost while a long call holds the store.
constexpr int QUEUE_SIZE = 200;
constexpr double WARNING_PERIOD_S = 5;
}  // namespace

KeyframeStore::KeyframeStore(ros::NodeHandle& node, ros::NodeHandle& private_node, const KeyframeStoreOptions& options)
    : options_(options),
      connection_(dataPath(options.store_path, "keyframes.sqlite")),
      preview_(options.preview),
      preview_publisher_(private_node, options.session_frame_id),
      store_(connection_, *this),
      state_(private_node.advertise<StoreState>(names::STATE, 1, true)),
      keyframes_(node.subscribe(names::KEYFRAME, QUEUE_SIZE, &KeyframeStore::takeKeyframe, this)),
      masks_(node.subscribe(names::MASK, QUEUE_SIZE, &KeyframeStore::takeMask, this)),
      preview_timer_(node.createWallTimer(ros::WallDuration(1 / options.preview_rate_hz),
                                          [this](const ros::WallTimerEvent&) { publishPreview(); })),
      services_(private_node, store_)
{
  const base::Status status = ros_bridge::guarded([this] { store_.listSessions(); });
  if (!status.ok())
    ROS_ERROR("%s", status.message.c_str());
  publishState(status);
}

void KeyframeStore::takeKeyframe(const object_modelling::Keyframe::ConstPtr& message)
{
  const base::Status status =
      ros_bridge::guarded([&] { store_.addKeyframe(message->session_id, ros_bridge::fromMessage(*message)); });
  if (status.ok())
    return;
  ++refused_count_;
  ROS_ERROR_THROTTLE(WARNING_PERIOD_S, "keyframe %d of session '%s' was not stored: %s", message->keyframe_id,
                     message->session_id.c_str(), status.message.c_str());
  publishState(status);
}

void KeyframeStore::takeMask(const object_modelling::ObjectMask::ConstPtr& message)
{
  const base::Status status = ros_bridge::guarded(
      [&] {
        store_.update(message->session_id, keyframes::SessionChange::ofMasks({ ros_bridge::fromMessage(*message) }));
      });
  if (status.ok())
    return;
  ++refused_count_;
  ROS_ERROR_THROTTLE(WARNING_PERIOD_S, "mask of keyframe %d of session '%s' was not stored: %s", message->keyframe_id,
                     message->session_id.c_str(), status.message.c_str());
  publishState(status);
}

bool KeyframeStore::turnPreviewTo(const std::string& session_id)
{
  if (preview_.sessionId() == session_id)
    return false;
  preview_.show(session_id);
  for (const int id : store_.keyframeIds(session_id))
    preview_.add(store_.keyframe(session_id, id));
  return true;
}

void KeyframeStore::onKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe)
{
  if (!turnPreviewTo(session_id))
    preview_.add(keyframe);
  preview_changed_ = true;
}

void KeyframeStore::onPoses(const std::string& session_id, const std::vector<keyframes::PoseUpdate>& updates)
{
  if (!turnPreviewTo(session_id))
    preview_.move(updates);
  preview_changed_ = true;
}

void KeyframeStore::onMasks(const std::string& session_id, const std::vector<keyframes::MaskUpdate>& updates)
{
  if (!turnPreviewTo(session_id))
    preview_.mask(updates);
  preview_changed_ = true;
}

void KeyframeStore::onDeleted(const std::string& session_id)
{
  if (preview_.sessionId() != session_id)
    return;
  preview_.show("");
  preview_changed_ = true;
}

void KeyframeStore::onWrite(const base::Status& status)
{
  publishState(status);
}

void KeyframeStore::publishState(const base::Status& status)
{
  StoreState state;
  state.header.stamp = ros::Time::now();
  state.status = ros_bridge::toMessage(status);
  state.store = connection_;
  state.current_session_id = preview_.sessionId();
  state.refused_count = refused_count_;
  const base::Status counted = ros_bridge::guarded(
      [&]
      {
        for (const keyframes::Session& session : store_.listSessions())
        {
          ++state.session_count;
          if (session.id == state.current_session_id)
            state.keyframe_count = session.keyframe_count;
        }
      });
  if (status.ok())
    state.status = ros_bridge::toMessage(counted);
  state_.publish(state);
}

void KeyframeStore::publishPreview()
{
  if (!preview_changed_)
    return;
  preview_changed_ = false;
  const base::Status status = ros_bridge::guarded([this] { preview_publisher_.publish(preview_); });
  if (!status.ok())
    ROS_WARN("no preview: %s", status.message.c_str());
}

}  // namespace object_modelling::nodes
