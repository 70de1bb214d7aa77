#include "progress_publisher.h"

#include <object_modelling/Progress.h>

#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
constexpr double MIN_INTERVAL_S = 0.05;
}

ProgressPublisher::ProgressPublisher(ros::NodeHandle& private_node)
    : publisher_(private_node.advertise<object_modelling::Progress>("progress", 10, true))
{
}

void ProgressPublisher::begin(const std::string& job)
{
  job_ = job;
  last_time_ = ros::WallTime();
  publish({}, true, {});
}

bool ProgressPublisher::report(const base::Progress& progress)
{
  const ros::WallTime now = ros::WallTime::now();
  const bool notable = progress.stage != last_.stage || progress.done == progress.total;
  if (!notable && (now - last_time_).toSec() < MIN_INTERVAL_S)
    return false;
  last_time_ = now;
  publish(progress, true, {});
  return true;
}

void ProgressPublisher::end(const base::Status& status)
{
  publish(last_, false, status);
}

void ProgressPublisher::publish(const base::Progress& progress, bool active, const base::Status& status)
{
  last_ = progress;
  object_modelling::Progress message;
  message.header.stamp = ros::Time::now();
  message.job = job_;
  message.active = active;
  message.stage = progress.stage;
  message.done = static_cast<std::uint32_t>(progress.done);
  message.total = static_cast<std::uint32_t>(progress.total);
  message.status = ros_bridge::toMessage(status);
  publisher_.publish(message);
}

}  // namespace object_modelling::nodes
