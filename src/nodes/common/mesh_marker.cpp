#include "mesh_marker.h"

namespace object_modelling::nodes
{
visualization_msgs::Marker meshMarker(const mesh::TriangleMesh& mesh, const std_msgs::Header& header)
{
  // As triangles, not as mesh resource: rviz draws vertex colours of these, and may run on another machine.
  visualization_msgs::Marker marker;
  marker.header = header;
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

}  // namespace object_modelling::nodes
