#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::nodes
{
/// A mesh with its vertex colours, grey without; at the origin of the header's frame. `ns` and `id` are the caller's.
visualization_msgs::Marker meshMarker(const mesh::TriangleMesh& mesh, const std_msgs::Header& header);

}  // namespace object_modelling::nodes
