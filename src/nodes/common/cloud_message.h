#pragma once

#include <cstdint>
#include <vector>

#include <sensor_msgs/PointCloud2.h>
#include <Eigen/Core>

namespace object_modelling::nodes
{
/// Unorganised cloud of x, y, z (m) and rgb, as rviz and PCL read it; white where `colors_rgb` is empty.
sensor_msgs::PointCloud2 cloudMessage(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<Eigen::Matrix<std::uint8_t, 3, 1>>& colors_rgb,
                                      const std_msgs::Header& header);

}  // namespace object_modelling::nodes
