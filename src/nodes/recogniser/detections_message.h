#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <object_modelling/Detections.h>
#include <visualization_msgs/MarkerArray.h>

#include "database_watch.h"

namespace object_modelling::nodes
{
/// What was found in one image, with what was known then.
struct FoundObjects
{
  std_msgs::Header header;  ///< of the colour image
  std::vector<recognition::Detection> detections;
  double duration_s = 0;
  std::shared_ptr<const KnownObjects> known;
};

object_modelling::Detections detectionsMessage(const FoundObjects& found);

/// Meshes with the vertex colours of the objects, and texts with id and confidence; takes back what was shown before.
visualization_msgs::MarkerArray markersOf(const FoundObjects& found);

/// Frames object_<id>_<n> below the image's, n counted from 0 for each id.
std::vector<geometry_msgs::TransformStamped> transformsOf(const FoundObjects& found);

}  // namespace object_modelling::nodes
