#include "support/handheld_trajectory.h"

#include <cmath>

#include <opencv2/core.hpp>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::test_support
{
namespace
{
/// Sum of a few sines with seeded frequencies and phases, within [-1, 1].
class Tremor
{
public:
  explicit Tremor(cv::RNG* random)
  {
    for (Wave& wave : waves_)
      wave = { random->uniform(0.5, 4.0), random->uniform(0.0, 2 * M_PI) };
  }
  double at(double time_s) const
  {
    double sum = 0;
    for (const Wave& wave : waves_)
      sum += std::sin(2 * M_PI * wave.frequency_hz * time_s + wave.phase_rad);
    return sum / 3;
  }

private:
  struct Wave
  {
    double frequency_hz, phase_rad;
  };
  Wave waves_[3];
};

}  // namespace

Eigen::Isometry3d lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target)
{
  const Eigen::Vector3d z = (target - eye).normalized();
  Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ());
  x = x.norm() > 1e-9 ? x.normalized() : Eigen::Vector3d::UnitX();
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() << x, z.cross(x), z;
  T_world_camera.translation() = eye;
  return T_world_camera;
}

Eigen::Isometry3d orbitPose(const Eigen::Vector3d& target, double radius_m, double azimuth_rad, double elevation_rad)
{
  const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                  std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
  return lookAt(target + radius_m * direction, target);
}

std::vector<StampedCamera> handheldTrajectory(const HandheldOptions& options)
{
  cv::RNG random(options.seed * 0x9e3779b97f4a7c15ULL + 7);
  std::vector<Tremor> tremors;
  for (int i = 0; i < 6; ++i)
    tremors.emplace_back(&random);
  std::vector<StampedCamera> trajectory;
  for (int i = 0; i < options.frame_count; ++i)
  {
    const double time_s = i / options.rate_hz;
    const double share = options.frame_count > 1 ? i / (options.frame_count - 1.0) : 0.0;
    const Eigen::Isometry3d T_world_orbit = orbitPose(
        options.target, options.radius_m, options.start_rad + share * options.turn_rad, options.elevation_rad);
    geometry::Vector6d shake;
    for (int axis = 0; axis < 6; ++axis)
      shake[axis] = (axis < 3 ? options.tremor_m : options.tremor_rad) * tremors[axis].at(time_s);
    trajectory.push_back({ options.start_s + time_s, T_world_orbit * geometry::isometryFromVector(shake) });
  }
  return trajectory;
}

std::vector<Eigen::Isometry3d> orbitPoses(int count, const Eigen::Vector3d& target, double radius_m,
                                          double elevation_rad)
{
  std::vector<Eigen::Isometry3d> T_world_cameras;
  for (int i = 0; i < count; ++i)
    T_world_cameras.push_back(orbitPose(target, radius_m, 2 * M_PI * i / count, elevation_rad));
  return T_world_cameras;
}

}  // namespace object_modelling::test_support
