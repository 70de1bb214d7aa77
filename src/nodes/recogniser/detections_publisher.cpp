#include "detections_publisher.h"

#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
DetectionsPublisher::DetectionsPublisher(ros::NodeHandle& private_node)
    : detections_(private_node.advertise<object_modelling::Detections>("detections", 10)),
      markers_(private_node.advertise<visualization_msgs::MarkerArray>("markers", 2)),
      database_(private_node.advertise<object_modelling::KnownObjects>("database", 1, true))
{
}

void DetectionsPublisher::publish(const FoundObjects& found, const object_modelling::Detections& message)
{
  detections_.publish(message);
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const geometry_msgs::TransformStamped& transform : transformsOf(found))
  {
    ros::Time& last = last_stamps_[transform.child_frame_id];
    if (last != transform.header.stamp)
      transforms.push_back(transform);
    last = transform.header.stamp;
  }
  broadcaster_.sendTransform(transforms);
  if (markers_.getNumSubscribers() > 0)
    markers_.publish(markersOf(found));
}

void DetectionsPublisher::publishKnown(const KnownObjects& known)
{
  database_.publish(knownMessage(known));
}

object_modelling::KnownObjects knownMessage(const KnownObjects& known)
{
  object_modelling::KnownObjects message;
  for (const auto& [id, object] : known.objects)
  {
    message.ids.push_back(id);
    message.content_hashes.push_back(object->content_hash);
  }
  message.status = ros_bridge::toMessage(known.status);
  return message;
}

}  // namespace object_modelling::nodes
