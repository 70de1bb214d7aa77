#pragma once

#include <string>

#include <ros/node_handle.h>

#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
/// Offers a service whose handler throws why it refuses: that becomes the status of an otherwise empty response, and is
/// logged.
template <typename Service, typename Owner>
ros::ServiceServer serve(ros::NodeHandle& node, const std::string& name, Owner* owner,
                         void (Owner::*handler)(const typename Service::Request&, typename Service::Response&))
{
  const boost::function<bool(typename Service::Request&, typename Service::Response&)> answer =
      [name, owner, handler](typename Service::Request& request, typename Service::Response& response)
  {
    const base::Status status = ros_bridge::guarded([&] { (owner->*handler)(request, response); });
    if (status.ok())
      return true;
    ROS_WARN("%s: %s", name.c_str(), status.message.c_str());
    response = typename Service::Response();
    response.status = ros_bridge::toMessage(status);
    return true;
  };
  return node.advertiseService(name, answer);
}

}  // namespace object_modelling::nodes
