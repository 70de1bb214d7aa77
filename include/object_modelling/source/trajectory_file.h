#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace object_modelling::source
{
struct StampedPose
{
  double stamp_s = 0;
  Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
};

/// TUM format: "stamp tx ty tz qx qy qz qw" per line, '#' comments. Written through a temporary file and renamed.
/// Reading throws base::Error: NOT_FOUND, or BAD_INPUT with file and line.
void writeTrajectory(const std::string& path, const std::vector<StampedPose>& trajectory);
std::vector<StampedPose> readTrajectory(const std::string& path);

}  // namespace object_modelling::source
