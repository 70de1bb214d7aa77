#include "model_preview.h"

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include "../common/cloud_message.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
namespace
{
visualization_msgs::Marker meshMarker(const mesh::TriangleMesh& mesh, const std_msgs::Header& header)
{
  // As triangles, not as mesh resource: rviz draws vertex colours of these, and may run on another machine.
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = "model";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color.r = marker.color.g = marker.color.b = 0.7F;
  marker.color.a = 1;
  for (const auto& triangle : mesh.triangles)
  {
    for (const std::uint32_t vertex : triangle)
    {
      geometry_msgs::Point point;
      point.x = mesh.vertices[vertex].x();
      point.y = mesh.vertices[vertex].y();
      point.z = mesh.vertices[vertex].z();
      marker.points.push_back(point);
      if (mesh.colors.empty())
        continue;
      std_msgs::ColorRGBA color;
      color.r = mesh.colors[vertex][0] / 255.0F;
      color.g = mesh.colors[vertex][1] / 255.0F;
      color.b = mesh.colors[vertex][2] / 255.0F;
      color.a = 1;
      marker.colors.push_back(color);
    }
  }
  return marker;
}
}  // namespace

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
  mesh_.publish(meshMarker(mesh, header));
}

}  // namespace object_modelling::nodes
