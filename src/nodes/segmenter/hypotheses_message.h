#pragma once

#include <object_modelling/Hypotheses.h>
#include <visualization_msgs/MarkerArray.h>

#include "object_modelling/rgbd/frame.h"
#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::nodes
{
/// `selected`: index of the selected hypothesis; -1 for none.
object_modelling::Hypotheses toMessage(const segmentation::SceneSegmentation& segmentation, int selected,
                                       const rgbd::Frame& frame, const std_msgs::Header& header);

/// Boxes and ids for rviz; the selected one is green. Begins by deleting the markers of the last call.
visualization_msgs::MarkerArray markersOf(const object_modelling::Hypotheses& hypotheses);

/// One cloud of all hypotheses, each in a colour of its own.
sensor_msgs::PointCloud2 cloudOf(const segmentation::SceneSegmentation& segmentation, int selected,
                                 const rgbd::Frame& frame, const std_msgs::Header& header);

}  // namespace object_modelling::nodes
