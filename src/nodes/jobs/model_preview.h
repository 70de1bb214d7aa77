#pragma once

#include <string>

#include <ros/node_handle.h>

#include "object_modelling/database/object_database.h"

namespace object_modelling::nodes
{
/// Shows the object that was built last where it stood in a session: latched ~model (PointCloud2, the mesh's vertices)
/// and ~model_mesh (Marker, triangles with vertex colours).
class ModelPreview
{
public:
  ModelPreview(ros::NodeHandle& private_node, const std::string& session_frame_id);

  /// Throws base::Error if the mesh cannot be read.
  void show(const database::ObjectEntry& object, const std::string& session_id);

private:
  std::string session_frame_id_;
  ros::Publisher cloud_, mesh_;
};

}  // namespace object_modelling::nodes
