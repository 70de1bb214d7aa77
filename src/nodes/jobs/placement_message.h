#pragma once

#include <string>
#include <vector>

#include <object_modelling/SessionPlacement.h>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
inline object_modelling::SessionPlacement placementMessage(const alignment::SessionPlacement& placement)
{
  object_modelling::SessionPlacement message;
  message.session_id = placement.session_id;
  message.reference_from_session = ros_bridge::toPoseMessage(placement.T_reference_session);
  return message;
}

/// A single session may leave its pose zero.
inline std::vector<alignment::SessionPlacement> placementsFrom(
    const std::vector<object_modelling::SessionPlacement>& messages)
{
  std::vector<alignment::SessionPlacement> placements;
  for (const object_modelling::SessionPlacement& message : messages)
  {
    alignment::SessionPlacement placement;
    placement.session_id = message.session_id;
    const bool left_zero = message.reference_from_session == geometry_msgs::Pose();
    if (!left_zero || messages.size() > 1)
      placement.T_reference_session = ros_bridge::fromMessage(message.reference_from_session);
    placements.push_back(placement);
  }
  return placements;
}

}  // namespace object_modelling::nodes
