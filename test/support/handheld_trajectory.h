#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace object_modelling::test_support
{
struct StampedCamera
{
  double stamp_s = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Camera at `eye` that looks at `target`, image upright (world z up).
Eigen::Isometry3d lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// On a sphere round `target`: azimuth from world x, elevation above the table.
Eigen::Isometry3d orbitPose(const Eigen::Vector3d& target, double radius_m, double azimuth_rad, double elevation_rad);

struct HandheldOptions
{
  Eigen::Vector3d target{ 0, 0, 0.08 };
  double radius_m = 0.7;
  double elevation_rad = 0.6;
  double start_rad = 0;
  double turn_rad = 2 * M_PI;  ///< way round the target from first to last frame
  int frame_count = 90;
  double rate_hz = 30;
  double start_s = 1000;
  double tremor_m = 0.004;    ///< of position, amplitude
  double tremor_rad = 0.006;  ///< of orientation, amplitude
  std::uint64_t seed = 1;
};

/// Somebody who walks round the target: an orbit with a smooth tremor of 0.5 to 4 Hz.
std::vector<StampedCamera> handheldTrajectory(const HandheldOptions& options = {});

/// `count` poses evenly round the target, without tremor; the last is one step short of the first.
std::vector<Eigen::Isometry3d> orbitPoses(int count, const Eigen::Vector3d& target = { 0, 0, 0.08 },
                                          double radius_m = 0.7, double elevation_rad = 0.6);

}  // namespace object_modelling::test_support
