#include "lossless_gate.h"

#include <chrono>

#include <ros/init.h>

namespace object_modelling::nodes
{
namespace
{
constexpr int QUEUE_SIZE = 20;
constexpr std::chrono::milliseconds SHUTDOWN_POLL(100);
}  // namespace

LosslessGate::LosslessGate(ros::NodeHandle& node, const std::string& state_topic)
    : subscriber_(node.subscribe(state_topic, QUEUE_SIZE, &LosslessGate::take, this))
{
}

void LosslessGate::take(const object_modelling::TrackingState::ConstPtr& state)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_stamp_ = state->header.stamp;
  }
  changed_.notify_all();
}

bool LosslessGate::waitFor(const ros::Time& stamp, double timeout_s)
{
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  std::unique_lock<std::mutex> lock(mutex_);
  while (last_stamp_ != stamp)
  {
    if (!ros::ok() || std::chrono::steady_clock::now() > deadline)
      return false;
    changed_.wait_for(lock, SHUTDOWN_POLL);
  }
  return true;
}

}  // namespace object_modelling::nodes
