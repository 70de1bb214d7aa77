#include "preview_publisher.h"

#include <array>

#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include "../common/cloud_message.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/time_conversion.h"

namespace object_modelling::nodes
{
namespace
{
constexpr double FRUSTUM_DEPTH_M = 0.04;
constexpr double LINE_WIDTH_M = 0.001;

geometry_msgs::Point toPoint(const Eigen::Vector3d& p)
{
  geometry_msgs::Point point;
  point.x = p.x();
  point.y = p.y();
  point.z = p.z();
  return point;
}

/// Pyramid of the image at FRUSTUM_DEPTH_M, as pairs of points.
void addFrustum(const SessionPreview::View& view, visualization_msgs::Marker* lines)
{
  const double right = view.camera.width - 0.5, bottom = view.camera.height - 0.5;
  const std::array<Eigen::Vector2d, 4> corners = { Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(right, -0.5),
                                                   Eigen::Vector2d(right, bottom), Eigen::Vector2d(-0.5, bottom) };
  const auto corner = [&](std::size_t i)
  {
    const Eigen::Vector2d& pixel = corners[i % corners.size()];
    return toPoint(view.T_session_camera * view.camera.unproject(pixel.x(), pixel.y(), FRUSTUM_DEPTH_M));
  };
  const geometry_msgs::Point center = toPoint(view.T_session_camera.translation());
  for (std::size_t i = 0; i < corners.size(); ++i)
    lines->points.insert(lines->points.end(), { center, corner(i), corner(i), corner(i + 1) });
}

visualization_msgs::MarkerArray frustaOf(const std::vector<SessionPreview::View>& views, const std_msgs::Header& header)
{
  visualization_msgs::MarkerArray message;
  message.markers.resize(1);
  visualization_msgs::Marker& lines = message.markers.front();
  lines.header = header;
  lines.ns = "keyframes";
  lines.type = visualization_msgs::Marker::LINE_LIST;
  lines.action = views.empty() ? visualization_msgs::Marker::DELETE : visualization_msgs::Marker::ADD;
  lines.pose.orientation.w = 1;
  lines.scale.x = LINE_WIDTH_M;
  lines.color.r = 0.1f;
  lines.color.g = 0.6f;
  lines.color.b = 1.0f;
  lines.color.a = 1.0f;
  for (const SessionPreview::View& view : views)
    addFrustum(view, &lines);
  return message;
}

nav_msgs::Path pathOf(const std::vector<SessionPreview::View>& views, const std_msgs::Header& header)
{
  nav_msgs::Path path;
  path.header = header;
  for (const SessionPreview::View& view : views)
  {
    geometry_msgs::PoseStamped pose;
    pose.header.frame_id = header.frame_id;
    pose.header.stamp = ros_bridge::toTime(view.stamp_s);
    pose.pose = ros_bridge::toPoseMessage(view.T_session_camera);
    path.poses.push_back(pose);
  }
  return path;
}
}  // namespace

PreviewPublisher::PreviewPublisher(ros::NodeHandle& private_node, const std::string& session_frame_id)
    : session_frame_id_(session_frame_id),
      cloud_(private_node.advertise<sensor_msgs::PointCloud2>("cloud", 1, true)),
      path_(private_node.advertise<nav_msgs::Path>("path", 1, true)),
      frusta_(private_node.advertise<visualization_msgs::MarkerArray>("frusta", 1, true))
{
}

void PreviewPublisher::publish(const SessionPreview& preview)
{
  const std::vector<SessionPreview::View> views = preview.views();
  std_msgs::Header header;
  header.frame_id = session_frame_id_;
  header.stamp = views.empty() ? ros::Time(0) : ros_bridge::toTime(views.back().stamp_s);
  const SessionPreview::Cloud cloud = preview.cloud();
  cloud_.publish(cloudMessage(cloud.points_session, cloud.colors_rgb, header));
  path_.publish(pathOf(views, header));
  frusta_.publish(frustaOf(views, header));
}

}  // namespace object_modelling::nodes
