#include "cloud_message.h"

#include <sensor_msgs/point_cloud2_iterator.h>

namespace object_modelling::nodes
{
sensor_msgs::PointCloud2 cloudMessage(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<Eigen::Matrix<std::uint8_t, 3, 1>>& colors_rgb,
                                      const std_msgs::Header& header)
{
  sensor_msgs::PointCloud2 message;
  message.header = header;
  message.is_dense = true;
  sensor_msgs::PointCloud2Modifier modifier(message);
  modifier.setPointCloud2FieldsByString(2, "xyz", "rgb");
  modifier.resize(points.size());
  message.height = 1;
  message.width = static_cast<std::uint32_t>(points.size());
  if (points.empty())
    return message;  // an iterator takes the address of the first byte
  sensor_msgs::PointCloud2Iterator<float> xyz(message, "x");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> bgr(message, "rgb");  // little-endian 0x00rrggbb
  for (std::size_t i = 0; i < points.size(); ++i, ++xyz, ++bgr)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      xyz[axis] = points[i][axis];
      bgr[axis] = colors_rgb.empty() ? 255 : colors_rgb[i][2 - axis];
    }
  }
  return message;
}

}  // namespace object_modelling::nodes
