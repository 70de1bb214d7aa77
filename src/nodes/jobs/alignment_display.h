#pragma once

#include <string>

#include <ros/node_handle.h>

#include "alignment_scene.h"

namespace object_modelling::nodes
{
/// An AlignmentScene in rviz: latched ~parts (PointCloud2) and ~labels (MarkerArray).
class AlignmentDisplay
{
public:
  AlignmentDisplay(ros::NodeHandle& private_node, const std::string& frame_id);

  const std::string& frameId() const { return frame_id_; }
  void show(const AlignmentScene& scene);
  /// What has been clicked, numbered within each part, and a line to the person.
  void showClicks(const AlignmentScene& scene, const std::vector<AlignmentScene::Spot>& spots,
                  const AlignmentScene::Label& notice);

private:
  std::string frame_id_;
  ros::Publisher parts_, labels_;
};

}  // namespace object_modelling::nodes
