#pragma once

#include <object_modelling/KnownObjects.h>
#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include "detections_message.h"

namespace object_modelling::nodes
{
/// ~detections, ~markers, latched ~database, and the frames of the objects.
class DetectionsPublisher
{
public:
  explicit DetectionsPublisher(ros::NodeHandle& private_node);

  void publish(const FoundObjects& found, const object_modelling::Detections& message);
  /// Safe for any thread.
  void publishKnown(const KnownObjects& known);

private:
  ros::Publisher detections_, markers_, database_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::map<std::string, ros::Time> last_stamps_;  ///< of each frame that was sent: tf warns of repeated ones
};

/// For ~database and ~reload.
object_modelling::KnownObjects knownMessage(const KnownObjects& known);

}  // namespace object_modelling::nodes
