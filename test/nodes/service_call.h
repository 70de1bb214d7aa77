#pragma once

#include <ros/ros.h>

#include <string>

namespace object_modelling::nodes
{
/// Calls a service that is advertised. The connection stays open until the response is here: roscpp may see that the
/// server closed a one-off connection before it reads the response, and calls that a failure (ros_comm issue 1976).
template <typename Service>
bool callService(const std::string& name, Service& service)
{
  return ros::NodeHandle().serviceClient<Service>(name, true).call(service);
}
}  // namespace object_modelling::nodes
