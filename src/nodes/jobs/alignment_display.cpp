#include "alignment_display.h"

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include "../common/cloud_message.h"

namespace object_modelling::nodes
{
namespace
{
std_msgs::ColorRGBA colorOf(AlignmentScene::Tone tone)
{
  std_msgs::ColorRGBA color;
  color.a = 1;
  color.r = tone == AlignmentScene::Tone::GOOD ? 0.2F : 1.0F;
  color.g = tone == AlignmentScene::Tone::BAD ? 0.35F : 1.0F;
  color.b = tone == AlignmentScene::Tone::PLAIN ? 1.0F : 0.3F;
  return color;
}

visualization_msgs::Marker marker(const std_msgs::Header& header, const std::string& group, int id, int type,
                                  const Eigen::Vector3d& position, double size_m, AlignmentScene::Tone tone)
{
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = group;
  marker.id = id;
  marker.type = type;
  marker.pose.position.x = position.x();
  marker.pose.position.y = position.y();
  marker.pose.position.z = position.z();
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = size_m;
  marker.color = colorOf(tone);
  return marker;
}

visualization_msgs::Marker text(const std_msgs::Header& header, const std::string& group, int id,
                                const AlignmentScene::Label& label, double size_m)
{
  visualization_msgs::Marker result =
      marker(header, group, id, visualization_msgs::Marker::TEXT_VIEW_FACING, label.position, size_m, label.tone);
  result.text = label.text;
  return result;
}

std_msgs::Header headerOf(const std::string& frame_id)
{
  std_msgs::Header header;
  header.frame_id = frame_id;
  header.stamp = ros::Time::now();
  return header;
}

visualization_msgs::Marker clearing(const std_msgs::Header& header)
{
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.action = visualization_msgs::Marker::DELETEALL;
  return marker;
}

visualization_msgs::MarkerArray labelsOf(const AlignmentScene& scene, const std_msgs::Header& header)
{
  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(clearing(header));
  for (const AlignmentScene::Label& label : scene.labels())
    markers.markers.push_back(
        text(header, "labels", static_cast<int>(markers.markers.size()), label, scene.letterHeight_m()));
  return markers;
}
}  // namespace

AlignmentDisplay::AlignmentDisplay(ros::NodeHandle& private_node, const std::string& frame_id)
    : frame_id_(frame_id),
      parts_(private_node.advertise<sensor_msgs::PointCloud2>("parts", 1, true)),
      labels_(private_node.advertise<visualization_msgs::MarkerArray>("labels", 1, true))
{
}

void AlignmentDisplay::show(const AlignmentScene& scene)
{
  parts_.publish(cloudMessage(scene.points(), scene.colors(), headerOf(frame_id_)));
  showClicks(
      scene, {},
      { scene.noticePosition(), "to align by hand, click three spots on each of the two in front, in the same order" });
}

void AlignmentDisplay::showClicks(const AlignmentScene& scene, const std::vector<AlignmentScene::Spot>& spots,
                                  const AlignmentScene::Label& notice)
{
  // All at once: a latched topic keeps one message.
  const std_msgs::Header header = headerOf(frame_id_);
  visualization_msgs::MarkerArray markers = labelsOf(scene, header);
  markers.markers.push_back(text(header, "notice", 0, notice, scene.letterHeight_m()));
  int of_a = 0, of_b = 0, id = 0;
  for (const AlignmentScene::Spot& spot : spots)
  {
    const Eigen::Vector3d at = scene.displayed(spot);
    const std::string number = std::to_string(spot.in_a ? ++of_a : ++of_b);
    markers.markers.push_back(marker(header, "clicks", id++, visualization_msgs::Marker::SPHERE, at,
                                     0.5 * scene.letterHeight_m(), AlignmentScene::Tone::BAD));
    markers.markers.push_back(text(header, "clicks", id++,
                                   { at + Eigen::Vector3d(0, 0, scene.letterHeight_m()), number },
                                   1.3 * scene.letterHeight_m()));
  }
  labels_.publish(markers);
}

}  // namespace object_modelling::nodes
