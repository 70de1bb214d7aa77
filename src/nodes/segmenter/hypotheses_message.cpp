#include "hypotheses_message.h"

#include <array>

#include "../common/cloud_message.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
using Color = Eigen::Matrix<std::uint8_t, 3, 1>;
using Points = std::vector<Eigen::Vector3f>;
using Colors = std::vector<Color>;

// Okabe and Ito's palette, without its green, which marks the selected hypothesis.
const std::array<Color, 6> PALETTE = { Color(230, 159, 0), Color(86, 180, 233), Color(240, 228, 66),
                                       Color(0, 114, 178), Color(213, 94, 0),   Color(204, 121, 167) };
const Color SELECTED(0, 158, 115);

Color colorOf(int index, int selected)
{
  return index == selected ? SELECTED : PALETTE[static_cast<std::size_t>(index) % PALETTE.size()];
}

/// Points of the mask, in the image's colours unless one is given.
void appendPoints(const cv::Mat& mask, const rgbd::Frame& frame, const Color* color, Points* points, Colors* colors)
{
  for (int v = 0; v < mask.rows; ++v)
  {
    const std::uint8_t* row = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u)
    {
      if (!row[u] || !(frame.depthAt_m(u, v) > 0))
        continue;
      const cv::Vec3b& bgr = frame.color_bgr.at<cv::Vec3b>(v, u);
      points->push_back(frame.point(u, v));
      colors->push_back(color ? *color : Color(bgr[2], bgr[1], bgr[0]));
    }
  }
}

object_modelling::ObjectHypothesis toMessage(const segmentation::Hypothesis& hypothesis, const rgbd::Frame& frame,
                                             const std_msgs::Header& header)
{
  object_modelling::ObjectHypothesis message;
  message.id = hypothesis.id;
  message.pixel_count = hypothesis.pixel_count;
  message.centroid.x = hypothesis.centroid_camera.x();
  message.centroid.y = hypothesis.centroid_camera.y();
  message.centroid.z = hypothesis.centroid_camera.z();
  message.box = ros_bridge::toPoseMessage(hypothesis.box_camera.T_frame_box);
  message.box_size_m.x = hypothesis.box_camera.size_m.x();
  message.box_size_m.y = hypothesis.box_camera.size_m.y();
  message.box_size_m.z = hypothesis.box_camera.size_m.z();
  Points points;
  Colors colors;
  appendPoints(hypothesis.mask, frame, nullptr, &points, &colors);
  message.cloud = cloudMessage(points, colors, header);
  return message;
}

visualization_msgs::Marker marker(const std_msgs::Header& header, const char* group, int id, int type)
{
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = group;
  marker.id = id;
  marker.type = type;
  marker.pose.orientation.w = 1;
  return marker;
}
}  // namespace

object_modelling::Hypotheses toMessage(const segmentation::SceneSegmentation& segmentation, int selected,
                                       const rgbd::Frame& frame, const std_msgs::Header& header)
{
  object_modelling::Hypotheses message;
  message.header = header;
  message.status = ros_bridge::toMessage(segmentation.status);
  message.has_support_plane = segmentation.support_plane >= 0;
  if (message.has_support_plane)
    message.support_plane = ros_bridge::toMessage(segmentation.planes[segmentation.support_plane].plane_camera);
  for (const segmentation::Hypothesis& hypothesis : segmentation.hypotheses)
    message.hypotheses.push_back(toMessage(hypothesis, frame, header));
  message.selected_id = selected;
  return message;
}

visualization_msgs::MarkerArray markersOf(const object_modelling::Hypotheses& hypotheses)
{
  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(marker(hypotheses.header, "", 0, visualization_msgs::Marker::CUBE));
  markers.markers.back().action = visualization_msgs::Marker::DELETEALL;
  for (const object_modelling::ObjectHypothesis& hypothesis : hypotheses.hypotheses)
  {
    const Color color = colorOf(hypothesis.id, hypotheses.selected_id);
    visualization_msgs::Marker box = marker(hypotheses.header, "box", hypothesis.id, visualization_msgs::Marker::CUBE);
    box.pose = hypothesis.box;
    box.scale = hypothesis.box_size_m;
    box.color.r = color[0] / 255.0F;
    box.color.g = color[1] / 255.0F;
    box.color.b = color[2] / 255.0F;
    box.color.a = 0.3F;
    markers.markers.push_back(box);

    visualization_msgs::Marker label =
        marker(hypotheses.header, "id", hypothesis.id, visualization_msgs::Marker::TEXT_VIEW_FACING);
    label.pose.position = hypothesis.centroid;
    label.scale.z = 0.03;
    label.color = box.color;
    label.color.a = 1;
    label.text = std::to_string(hypothesis.id) + (hypothesis.id == hypotheses.selected_id ? " (selected)" : "");
    markers.markers.push_back(label);
  }
  return markers;
}

sensor_msgs::PointCloud2 cloudOf(const segmentation::SceneSegmentation& segmentation, int selected,
                                 const rgbd::Frame& frame, const std_msgs::Header& header)
{
  Points points;
  Colors colors;
  for (const segmentation::Hypothesis& hypothesis : segmentation.hypotheses)
  {
    const Color color = colorOf(hypothesis.id, selected);
    appendPoints(hypothesis.mask, frame, &color, &points, &colors);
  }
  return cloudMessage(points, colors, header);
}

}  // namespace object_modelling::nodes
