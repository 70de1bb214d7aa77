#include "support/synthetic_bundle.h"

#include <cmath>
#include <limits>

#include <opencv2/core.hpp>

#include "object_modelling/rgbd/sensor_noise_model.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::test_support
{
namespace
{
constexpr double SPHERE_RADIUS_M = 0.15;

/// Even cover of the sphere (golden spiral).
Eigen::Vector3d spherePoint(int index, int count)
{
  const double z = 1 - (2.0 * index + 1) / count;
  const double azimuth = index * M_PI * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return SPHERE_RADIUS_M * Eigen::Vector3d(r * std::cos(azimuth), r * std::sin(azimuth), z);
}

geometry::Vector6d gaussianVector(double sigma_m, double sigma_rad, cv::RNG* random)
{
  geometry::Vector6d vector;
  for (int axis = 0; axis < 6; ++axis)
    vector[axis] = random->gaussian(axis < 3 ? sigma_m : sigma_rad);
  return vector;
}

class Observer
{
public:
  explicit Observer(const SyntheticBundleOptions& options)
      : options_(options), camera_(vgaCamera()), random_(options.seed * 0x9e3779b97f4a7c15ULL + 3)
  {
  }
  cv::RNG* random() { return &random_; }

  void observe(const std::vector<Eigen::Vector3d>& p_world, const Eigen::Isometry3d& T_world_camera,
               rgbd::Keyframe* keyframe, std::vector<bool>* outliers)
  {
    const Eigen::Isometry3d T_camera_world = T_world_camera.inverse(Eigen::Isometry);
    for (std::size_t id = 0; id < p_world.size(); ++id)
    {
      const Eigen::Vector3d p = T_camera_world * p_world[id];
      const Eigen::Vector3d n = T_camera_world.linear() * p_world[id].normalized();
      const double theta = std::acos(-n.dot(p.normalized()));
      if (theta > 70 * M_PI / 180 || !camera_.contains(camera_.project(p)))
        continue;
      rgbd::Observation observation;
      observation.landmark_id = id;
      outliers->push_back(random_.uniform(0.0, 1.0) < options_.outlier_ratio);
      observation.pixel = pixel(camera_.project(p), outliers->back()).cast<float>();
      observation.depth_m = depth(p.z(), theta);
      keyframe->observations.push_back(observation);
    }
    keyframe->frame.camera = camera_;
  }

private:
  Eigen::Vector2d pixel(const Eigen::Vector2d& truth, bool outlier)
  {
    Eigen::Vector2d seen =
        truth + Eigen::Vector2d(random_.gaussian(options_.pixel_sigma_px), random_.gaussian(options_.pixel_sigma_px));
    while (outlier && (seen - truth).norm() < 20)
      seen = { random_.uniform(0.0, camera_.width - 1.0), random_.uniform(0.0, camera_.height - 1.0) };
    return seen;
  }
  float depth(double truth_m, double theta_rad)
  {
    const double noise_m =
        options_.depth_sigma_scale * random_.gaussian(rgbd::SensorNoiseModel().axialSigma_m(truth_m, theta_rad));
    const bool missing = random_.uniform(0.0, 1.0) < options_.missing_depth_ratio;
    return missing ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(truth_m + noise_m);
  }

  SyntheticBundleOptions options_;
  geometry::PinholeCamera camera_;
  cv::RNG random_;
};

}  // namespace

SyntheticBundle makeSyntheticBundle(const SyntheticBundleOptions& options)
{
  const double step_rad = options.step_rad > 0 ? options.step_rad : 2 * M_PI / options.camera_count;
  std::vector<Eigen::Isometry3d> T_world_cameras;
  for (int k = 0; k < options.camera_count; ++k)
    T_world_cameras.push_back(
        orbitPose(Eigen::Vector3d::Zero(), options.radius_m, k * step_rad, options.elevation_rad));
  const Eigen::Isometry3d T_session_world = T_world_cameras.front().inverse(Eigen::Isometry);
  std::vector<Eigen::Vector3d> p_world;
  for (int i = 0; i < options.landmark_count; ++i)
    p_world.push_back(spherePoint(i, options.landmark_count));

  SyntheticBundle bundle;
  for (const Eigen::Vector3d& p : p_world)
    bundle.landmarks.push_back(T_session_world * p);
  Observer observer(options);
  for (const Eigen::Isometry3d& T_world_camera : T_world_cameras)
  {
    const Eigen::Isometry3d T_session_camera = T_session_world * T_world_camera;
    rgbd::Keyframe keyframe;
    keyframe.id = static_cast<int>(bundle.keyframes.size());
    keyframe.frame.stamp_s = keyframe.id;
    std::vector<bool> outliers;
    observer.observe(p_world, T_world_camera, &keyframe, &outliers);
    const geometry::Vector6d error = gaussianVector(options.pose_error_m, options.pose_error_rad, observer.random());
    keyframe.T_session_camera =
        keyframe.id == 0 ? T_session_camera : T_session_camera * geometry::isometryFromVector(error);
    bundle.T_session_cameras.push_back(T_session_camera);
    bundle.keyframes.push_back(keyframe);
    bundle.observation_outliers.push_back(outliers);
  }
  return bundle;
}

}  // namespace object_modelling::test_support
