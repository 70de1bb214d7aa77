#pragma once

#include <string>

#include <ros/node_handle.h>

#include "session_preview.h"

namespace object_modelling::nodes
{
/// Publishes a session's preview, latched: ~cloud, ~path, ~frusta.
class PreviewPublisher
{
public:
  PreviewPublisher(ros::NodeHandle& private_node, const std::string& session_frame_id);
  void publish(const SessionPreview& preview);

private:
  std::string session_frame_id_;
  ros::Publisher cloud_, path_, frusta_;
};

}  // namespace object_modelling::nodes
