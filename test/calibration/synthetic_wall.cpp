#include "synthetic_wall.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/synthetic_scene.h"

namespace object_modelling::calibration
{
namespace
{
constexpr double HALF_WIDTH_M = 0.9, HALF_HEIGHT_M = 0.7, BACKGROUND_M = 1;

/// Depth of the rectangle on the ray (x, y, 1), and the angle it is seen at; 0 beside it.
double wallDepth_m(const WallPose& pose, double x, double y, bool endless, double* theta_rad)
{
  const Eigen::Vector3d n(std::sin(pose.tilt_rad), 0, -std::cos(pose.tilt_rad)), ray(x, y, 1);
  const Eigen::Vector3d center(0, 0, pose.distance_m);
  const double facing = n.dot(ray);
  if (facing > -1e-3)
    return 0;
  const Eigen::Vector3d p = ray * (n.dot(center) / facing);
  const Eigen::Vector3d across(std::cos(pose.tilt_rad), 0, std::sin(pose.tilt_rad));
  *theta_rad = std::acos(std::min(1.0, -facing / ray.norm()));
  const bool inside = std::abs(across.dot(p - center)) <= HALF_WIDTH_M && std::abs(p.y()) <= HALF_HEIGHT_M;
  return endless || inside ? p.z() : 0;
}
}  // namespace

std::vector<WallPose> walk(double nearest_m, double farthest_m, double widest_rad, int count)
{
  std::vector<WallPose> poses;
  for (int i = 0; i < count; ++i)
  {
    const double share = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
    poses.push_back({ nearest_m + (farthest_m - nearest_m) * share, widest_rad * std::sin(2.4 * i) });
  }
  return poses;
}

std::optional<rgbd::RawFrame> SyntheticWallSource::next()
{
  if (next_ == wall_.poses.size())
    return std::nullopt;
  const WallPose pose = wall_.poses[next_];
  rgbd::RawFrame raw;
  raw.stamp_s = raw.depth_stamp_s = 100.0 + static_cast<double>(next_++);
  raw.camera = test_support::vgaCamera();
  raw.color = cv::Mat::zeros(raw.camera.height, raw.camera.width, CV_8UC1);
  raw.depth = cv::Mat(raw.color.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  const rgbd::SensorNoiseModel& sensor = wall_.sensor;
  std::normal_distribution<double> gaussian;
  std::uniform_real_distribution<double> uniform;
  for (int v = 0; v < raw.depth.rows; ++v)
    for (int u = 0; u < raw.depth.cols; ++u)
    {
      const auto ray = [&](double du, double dv) { return raw.camera.unproject(u + du, v + dv, 1); };
      double theta_rad = 0;
      const double lateral_px = sensor.lateralSigma_px(std::min(std::abs(pose.tilt_rad), 1.4));
      const Eigen::Vector3d shifted = ray(lateral_px * gaussian(random_), lateral_px * gaussian(random_));
      const bool on_wall = wallDepth_m(pose, shifted.x(), shifted.y(), false, &theta_rad) > 0;
      double z_m = wallDepth_m(pose, ray(0, 0).x(), ray(0, 0).y(), true, &theta_rad);
      if (!on_wall || !(z_m > 0))
      {
        z_m = pose.distance_m + HALF_WIDTH_M + BACKGROUND_M;
        theta_rad = 0.3;
      }
      if (u < wall_.clutter_ratio * raw.depth.cols)
        z_m = 0.4 + 0.1 * std::sin(0.05 * u) * std::sin(0.07 * v);
      if (uniform(random_) < wall_.missing_ratio)
        continue;
      // Measured z such that measured - bias(measured) - distortion is the truth.
      const double truth_m = z_m;
      for (int i = 0; i < 5; ++i)
        z_m = truth_m + sensor.depthBias_m(z_m) +
              rgbd::DistortionGrid::ratioAt(sensor.depth_distortion_ratio, u, v, 640, 480) * z_m;
      z_m += gaussian(random_) * sensor.axialSigma_m(truth_m, std::min(theta_rad, 1.45));
      if (uniform(random_) < wall_.outlier_ratio)
        z_m += uniform(random_) - 0.5;
      raw.depth.at<float>(v, u) = static_cast<float>(z_m);
    }
  return raw;
}

}  // namespace object_modelling::calibration
