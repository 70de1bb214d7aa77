#include "object_modelling/ros_bridge/timed_call.h"

#include <sstream>

#include <ros/service.h>

namespace object_modelling::ros_bridge
{
base::Error notAnswering(const std::string& what, const std::string& detail)
{
  return base::Error(
      base::StatusCode::TIMEOUT,
      what + " does not answer (" + detail + "): is its node running and in the same namespace? See 'rosnode list'");
}

std::string secondsText(double duration_s)
{
  std::ostringstream text;
  text << duration_s << " s";
  return text.str();
}

void throwIfShuttingDown()
{
  // Not ros::ok(): that holds until the callbacks of services have returned.
  if (ros::isShuttingDown())
    throw base::Error(base::StatusCode::CANCELLED, "the node is being shut down");
}

void waitForService(const std::string& resolved_name, double wait_s)
{
  const ros::WallDuration poll(0.02);
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(wait_s);
  while (!ros::service::exists(resolved_name, false))
  {
    throwIfShuttingDown();
    if (ros::WallTime::now() > end)
      throw notAnswering("service '" + resolved_name + "'", "not offered within " + secondsText(wait_s));
    poll.sleep();
  }
}

}  // namespace object_modelling::ros_bridge
