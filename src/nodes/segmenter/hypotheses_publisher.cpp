#include "hypotheses_publisher.h"

#include "hypotheses_message.h"

namespace object_modelling::nodes
{
HypothesesPublisher::HypothesesPublisher(ros::NodeHandle& private_node)
    : hypotheses_(private_node.advertise<object_modelling::Hypotheses>("hypotheses", 1)),
      markers_(private_node.advertise<visualization_msgs::MarkerArray>("hypotheses_markers", 1)),
      cloud_(private_node.advertise<sensor_msgs::PointCloud2>("hypotheses_cloud", 1))
{
}

bool HypothesesPublisher::wanted() const
{
  return hypotheses_.getNumSubscribers() + markers_.getNumSubscribers() + cloud_.getNumSubscribers() > 0;
}

void HypothesesPublisher::publish(const StampedFrame& frame, const segmentation::SceneSegmentation& segmentation,
                                  int selected) const
{
  if (!wanted())
    return;
  const object_modelling::Hypotheses message = toMessage(segmentation, selected, frame.frame, frame.header);
  hypotheses_.publish(message);
  markers_.publish(markersOf(message));
  cloud_.publish(cloudOf(segmentation, selected, frame.frame, frame.header));
}

}  // namespace object_modelling::nodes
