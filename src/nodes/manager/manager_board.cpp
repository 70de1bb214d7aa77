#include "manager_board.h"

#include <object_modelling/Progress.h>

#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
constexpr int QUEUE_SIZE = 10;

object_modelling::Progress progressMessage(const std::string& object_id)
{
  object_modelling::Progress message;
  message.header.stamp = ros::Time::now();
  message.job = "build " + object_id;
  return message;
}
}  // namespace

ManagerBoard::ManagerBoard(ros::NodeHandle& private_node)
    : state_publisher_(private_node.advertise<object_modelling::ManagerState>("state", QUEUE_SIZE, true)),
      progress_publisher_(private_node.advertise<object_modelling::Progress>("progress", QUEUE_SIZE, true))
{
  publishState();
}

void ManagerBoard::succeeded(const std::string& note)
{
  status_ = { base::StatusCode::OK, note };
  publishState();
}

void ManagerBoard::failed(const base::Status& status)
{
  ROS_WARN("%s", status.message.c_str());
  status_ = status;
  publishState();
}

void ManagerBoard::publishState()
{
  object_modelling::ManagerState message;
  message.header.stamp = ros::Time::now();
  message.state = static_cast<std::uint8_t>(state.phase());
  message.session_id = state.sessionId();
  message.object_id = state.objectId();
  message.keyframe_count = state.keyframeCount();
  message.stage = state.stage();
  message.status = ros_bridge::toMessage(status_);
  message.built = built_;
  state_publisher_.publish(message);
}

void ManagerBoard::progress(const std::string& object_id, const base::Progress& progress)
{
  if (last_object_id_ == object_id && last_progress_.stage == progress.stage && last_progress_.done == progress.done &&
      last_progress_.total == progress.total)
    return;
  last_object_id_ = object_id;
  last_progress_ = progress;
  object_modelling::Progress message = progressMessage(object_id);
  message.active = true;
  message.stage = progress.stage;
  message.done = static_cast<std::uint32_t>(progress.done);
  message.total = static_cast<std::uint32_t>(progress.total);
  progress_publisher_.publish(message);
}

void ManagerBoard::finished(const std::string& object_id, const base::Status& status)
{
  last_object_id_.clear();
  object_modelling::Progress message = progressMessage(object_id);
  message.status = ros_bridge::toMessage(status);
  progress_publisher_.publish(message);
}

}  // namespace object_modelling::nodes
