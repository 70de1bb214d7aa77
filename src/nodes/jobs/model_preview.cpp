#include "model_preview.h"

#include <sensor_msgs/PointCloud2.h>

#include "../common/cloud_message.h"
#include "../common/mesh_marker.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
ModelPreview::ModelPreview(ros::NodeHandle& private_node, const std::string& session_frame_id)
    : session_frame_id_(session_frame_id),
      cloud_(private_node.advertise<sensor_msgs::PointCloud2>("model", 1, true)),
      mesh_(private_node.advertise<visualization_msgs::Marker>("model_mesh", 1, true))
{
}

void ModelPreview::show(const database::ObjectEntry& object, const std::string& session_id)
{
  Eigen::Isometry3d T_session_model = Eigen::Isometry3d::Identity();
  for (const database::ModelSession& session : object.sessions)
    if (session.id == session_id)
      T_session_model = session.T_model_session.inverse();
  mesh::TriangleMesh mesh = mesh::readMesh(object.mesh_path);
  mesh::transform(T_session_model, &mesh);
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = session_frame_id_;
  cloud_.publish(cloudMessage(mesh.vertices, mesh.colors, header));
  visualization_msgs::Marker marker = meshMarker(mesh, header);
  marker.ns = "model";
  mesh_.publish(marker);
}

}  // namespace object_modelling::nodes
