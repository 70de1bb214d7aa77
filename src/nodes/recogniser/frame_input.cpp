#include "frame_input.h"

#include <algorithm>
#include <sstream>

namespace object_modelling::nodes
{
namespace
{
/// Of a wait; so long at most does the end of the node take.
constexpr double MAX_STEP_S = 0.1;

ros::NodeHandle& withQueue(ros::NodeHandle& node, ros::CallbackQueue* queue)
{
  node.setCallbackQueue(queue);
  return node;
}
}  // namespace

FrameInput::FrameInput(const ros::NodeHandle& node, const rgbd::FrameBuilderOptions& options)
    : node_(node), newest_(withQueue(node_, &queue_), options)
{
}

ros::Time FrameInput::stamp()
{
  queue_.callAvailable();
  return newest_.stamp();
}

base::Result<StampedFrame> FrameInput::get(double timeout_s)
{
  if (stamp().isZero())
    waitForOtherThan(ros::Time(), timeout_s);
  return newest_.get();
}

base::Result<StampedFrame> FrameInput::getNext(double wait_s)
{
  const ros::Time before = stamp();
  if (waitForOtherThan(before, wait_s) || before.isZero())
    return newest_.get();
  std::ostringstream text;
  text << "no frame has come within " << wait_s << " s after the call (the newest has stamp " << before
       << "); is the camera still running?";
  base::Result<StampedFrame> result;
  result.status = { base::StatusCode::TIMEOUT, text.str() };
  return result;
}

bool FrameInput::waitForOtherThan(const ros::Time& stamp, double timeout_s)
{
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(timeout_s);
  while (newest_.stamp() == stamp)
  {
    const double left_s = (end - ros::WallTime::now()).toSec();
    if (left_s <= 0 || !ros::ok())
      return false;
    queue_.callAvailable(ros::WallDuration(std::min(left_s, MAX_STEP_S)));
  }
  return true;
}

}  // namespace object_modelling::nodes
