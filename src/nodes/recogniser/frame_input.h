#pragma once

#include <ros/callback_queue.h>

#include "../common/newest_frame.h"

namespace object_modelling::nodes
{
/// The camera's newest frame, which a service callback can wait for: the images have a queue of their own, emptied by
/// whoever asks for a frame. Not thread safe.
class FrameInput
{
public:
  FrameInput(const ros::NodeHandle& node, const rgbd::FrameBuilderOptions& options);

  /// As NewestFrame::get(), after at most `timeout_s` of the wall clock where there is no frame yet.
  base::Result<StampedFrame> get(double timeout_s);
  /// A frame that comes after the call. TIMEOUT if there is none within `wait_s`.
  base::Result<StampedFrame> getNext(double wait_s);
  /// Stamp of the newest frame that has come; 0 before the first.
  ros::Time stamp();

private:
  /// Takes messages until the newest frame's stamp is not `stamp`, or the time is over.
  bool waitForOtherThan(const ros::Time& stamp, double timeout_s);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  NewestFrame newest_;
};

}  // namespace object_modelling::nodes
