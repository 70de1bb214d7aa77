#include "detections_message.h"

#include <cstdio>

#include "../common/mesh_marker.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
namespace
{
constexpr double TEXT_HEIGHT_M = 0.03;

object_modelling::Detection detectionMessage(const recognition::Detection& detection,
                                             const recognition::ObjectKnowledge& object)
{
  object_modelling::Detection message;
  message.object_id = detection.object_id;
  message.name = object.name;
  message.content_hash = detection.content_hash;
  message.confidence_ratio = detection.confidence_ratio;
  message.visible_ratio = detection.visible_ratio;
  message.pose = ros_bridge::toMessage(detection.T_camera_model, detection.covariance);
  message.size_m = ros_bridge::toVectorMessage(object.box_model.size_m);
  message.model_from_box = ros_bridge::toPoseMessage(object.box_model.T_frame_box);
  return message;
}

visualization_msgs::Marker textMarker(const recognition::Detection& detection,
                                      const recognition::ObjectKnowledge& object, const std_msgs::Header& header)
{
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  char confidence[16];
  std::snprintf(confidence, sizeof(confidence), " %.2f", detection.confidence_ratio);
  marker.text = detection.object_id + confidence;
  // y of the optical frame is downwards.
  const Eigen::Vector3d center_camera = detection.T_camera_model * object.center_model.cast<double>();
  marker.pose.position.x = center_camera.x();
  marker.pose.position.y = center_camera.y() - object.diameter_m / 2 - TEXT_HEIGHT_M;
  marker.pose.position.z = center_camera.z();
  marker.pose.orientation.w = 1;
  marker.scale.z = TEXT_HEIGHT_M;
  marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1;
  return marker;
}
}  // namespace

object_modelling::Detections detectionsMessage(const FoundObjects& found)
{
  object_modelling::Detections message;
  message.header = found.header;
  message.seconds = found.duration_s;
  for (const recognition::Detection& detection : found.detections)
    message.detections.push_back(detectionMessage(detection, *found.known->objects.at(detection.object_id)));
  return message;
}

visualization_msgs::MarkerArray markersOf(const FoundObjects& found)
{
  visualization_msgs::MarkerArray array;
  array.markers.resize(1);
  array.markers[0].header = found.header;
  array.markers[0].action = visualization_msgs::Marker::DELETEALL;
  int id = 0;
  for (const recognition::Detection& detection : found.detections)
  {
    const recognition::ObjectKnowledge& object = *found.known->objects.at(detection.object_id);
    visualization_msgs::Marker mesh = meshMarker(object.mesh, found.header);
    mesh.pose = ros_bridge::toPoseMessage(detection.T_camera_model);
    mesh.ns = "objects";
    mesh.id = id;
    array.markers.push_back(std::move(mesh));
    visualization_msgs::Marker text = textMarker(detection, object, found.header);
    text.ns = "names";
    text.id = id++;
    array.markers.push_back(std::move(text));
  }
  return array;
}

std::vector<geometry_msgs::TransformStamped> transformsOf(const FoundObjects& found)
{
  std::vector<geometry_msgs::TransformStamped> transforms;
  std::map<std::string, int> counts;
  for (const recognition::Detection& detection : found.detections)
  {
    geometry_msgs::TransformStamped transform;
    transform.header = found.header;
    transform.child_frame_id = "object_" + detection.object_id + "_" + std::to_string(counts[detection.object_id]++);
    transform.transform = ros_bridge::toTransformMessage(detection.T_camera_model);
    transforms.push_back(transform);
  }
  return transforms;
}

}  // namespace object_modelling::nodes
