#pragma once

#include <chrono>
#include <future>
#include <string>

#include <ros/init.h>
#include <ros/node_handle.h>

#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/status_conversion.h"

// Calls of other nodes' services. Each ends in time, and at once when this node is shut down: roscpp alone waits
// without limit for the answer of a node that hangs, and its shutdown waits for the callbacks that wait so.
namespace object_modelling::ros_bridge
{
struct CallLimits
{
  double wait_s = 5;     ///< how long to wait for a service that is not there
  double answer_s = 60;  ///< how long one call may take
};

/// TIMEOUT: `what` ("service '/a/b'") belongs to a node that is down or silent.
base::Error notAnswering(const std::string& what, const std::string& detail);

/// "0.5 s".
std::string secondsText(double duration_s);

/// CANCELLED once this node is being shut down.
void throwIfShuttingDown();

/// Returns once the service is offered, TIMEOUT otherwise.
void waitForService(const std::string& resolved_name, double wait_s);

/// Waits for the answer of a persistent connection. False: the connection is broken. No call begins once the node is
/// being shut down: roscpp would block it on what its shutdown holds while that waits for the caller's callback.
template <typename Service>
bool answered(const std::string& resolved_name, ros::ServiceClient client, double answer_s, Service& service)
{
  constexpr std::chrono::milliseconds POLL(50);
  throwIfShuttingDown();
  std::future<bool> done = std::async(std::launch::async, [&client, &service] { return client.call(service); });
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(answer_s);
  while (done.wait_for(POLL) != std::future_status::ready)
  {
    if (!ros::isShuttingDown() && std::chrono::steady_clock::now() < end)
      continue;
    // Ends the call.
    client.shutdown();
    if (done.get())
      return true;
    throwIfShuttingDown();
    throw notAnswering("service '" + resolved_name + "'", "no answer within " + secondsText(answer_s));
  }
  return done.get();
}

/// A connection of its own to a service, waiting for it: shutting it down ends a call.
template <typename Service>
ros::ServiceClient connected(ros::NodeHandle node, const std::string& resolved_name, double wait_s)
{
  waitForService(resolved_name, wait_s);
  throwIfShuttingDown();
  return node.serviceClient<Service>(resolved_name, true);
}

/// One call of a service, relative to the node handle. Throws the error of the response's status, if any.
template <typename Service>
void callInTime(const ros::NodeHandle& node, const std::string& name, const CallLimits& limits, Service& service)
{
  const std::string resolved = node.resolveName(name);
  if (!answered(resolved, connected<Service>(node, resolved, limits.wait_s), limits.answer_s, service))
  {
    throwIfShuttingDown();
    throw notAnswering("service '" + resolved + "'", "it went away during the call");
  }
  throwUnlessOk(service.response.status);
}

}  // namespace object_modelling::ros_bridge
