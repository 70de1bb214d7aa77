#pragma once

#include <ros/node_handle.h>

#include "../common/newest_frame.h"
#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::nodes
{
/// ~hypotheses and, for rviz, ~hypotheses_markers and ~hypotheses_cloud.
class HypothesesPublisher
{
public:
  explicit HypothesesPublisher(ros::NodeHandle& private_node);

  bool wanted() const;
  /// `selected`: index of the selected hypothesis; -1 for none.
  void publish(const StampedFrame& frame, const segmentation::SceneSegmentation& segmentation, int selected) const;

private:
  ros::Publisher hypotheses_, markers_, cloud_;
};

}  // namespace object_modelling::nodes
