#pragma once

#include <string>

#include <ros/node_handle.h>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::ros_bridge
{
/// Publishes rectified frames under image_pipeline's names (names.h), as a camera driver does.
class FramePublisher
{
public:
  FramePublisher(ros::NodeHandle& node, const std::string& frame_id);

  /// `raw_camera` is the camera before rectification; K and D of the CameraInfo describe it, P describes frame.camera.
  /// The mask is published if the frame has one.
  void publish(const rgbd::Frame& frame, const ros::Time& color_stamp, const ros::Time& depth_stamp,
               const geometry::PinholeCamera& raw_camera);

  /// Whether colour, depth and camera info are all listened to.
  bool connected() const
  {
    return color_.getNumSubscribers() > 0 && depth_.getNumSubscribers() > 0 && info_.getNumSubscribers() > 0;
  }

  /// Whether every subscriber registered with the master for one of the topics has connected to it: before that, it
  /// would miss a part of the first frame. Calls the master.
  bool allConnected() const;

private:
  std::string frame_id_;
  ros::Publisher color_, depth_, info_, mask_;
};

}  // namespace object_modelling::ros_bridge
