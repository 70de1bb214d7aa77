#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::refinement
{
struct LandmarkSceneOptions
{
  int keyframe_count = 12;
  double arc_rad = 2.2;  ///< that the cameras span round the object
  int landmark_count = 400;
  double pixel_noise_px = 0;
  double depth_noise_sigmas = 0;
  double outlier_ratio = 0;  ///< observations moved by tens of pixels
  double missing_depth_ratio = 0;
  double max_view_angle_rad = 0.7;
  unsigned seed = 7;
};

/// Landmarks on a sphere of 0.15 m, cameras on an arc 0.7 m from its centre looking at it; keyframes carry observations
/// only, no images. Exact truth: T_session_camera of every keyframe, the first at identity.
inline std::vector<rgbd::Keyframe> makeLandmarkScene(const LandmarkSceneOptions& options)
{
  std::mt19937 random(options.seed);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Eigen::Vector3d> landmarks;
  for (int i = 0; i < options.landmark_count; ++i)
    landmarks.push_back(0.15 * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized());

  geometry::PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525;
  camera.cx = 319.5;
  camera.cy = 239.5;
  std::vector<rgbd::Keyframe> keyframes;
  Eigen::Isometry3d T_first_object = Eigen::Isometry3d::Identity();
  for (int k = 0; k < options.keyframe_count; ++k)
  {
    const double angle = options.arc_rad * k / std::max(1, options.keyframe_count - 1);
    Eigen::Isometry3d T_object_camera = Eigen::Isometry3d::Identity();
    T_object_camera.linear() = Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    T_object_camera.translation() = T_object_camera.linear() * Eigen::Vector3d(0, 0, -0.7);
    if (k == 0)
      T_first_object = T_object_camera.inverse();
    rgbd::Keyframe keyframe;
    keyframe.id = k;
    keyframe.frame.camera = camera;
    keyframe.T_session_camera = T_first_object * T_object_camera;
    for (std::size_t i = 0; i < landmarks.size(); ++i)
    {
      const Eigen::Vector3d to_camera = (T_object_camera.translation() - landmarks[i]).normalized();
      if (to_camera.dot(landmarks[i].normalized()) < std::cos(options.max_view_angle_rad))
        continue;
      const Eigen::Vector3d p_camera = T_object_camera.inverse() * landmarks[i];
      rgbd::Observation observation;
      observation.landmark_id = i;
      Eigen::Vector2d pixel = camera.project(p_camera);
      pixel += options.pixel_noise_px * Eigen::Vector2d(normal(random), normal(random));
      if (uniform(random) < options.outlier_ratio)
        pixel += 40 * Eigen::Vector2d(normal(random), normal(random));
      observation.pixel = pixel.cast<float>();
      observation.depth_m = static_cast<float>(p_camera.z() + options.depth_noise_sigmas * normal(random) *
                                                                  rgbd::axialSigma_m(p_camera.z(), 0));
      if (uniform(random) < options.missing_depth_ratio)
        observation.depth_m = std::numeric_limits<float>::quiet_NaN();
      keyframe.observations.push_back(observation);
    }
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

/// Poses but the first moved at random, each on its own.
inline std::vector<rgbd::Keyframe> perturbed(std::vector<rgbd::Keyframe> keyframes, double translation_m,
                                             double rotation_rad, unsigned seed = 3)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t k = 1; k < keyframes.size(); ++k)
  {
    geometry::Vector6d motion;
    for (int i = 0; i < 6; ++i)
      motion[i] = normal(random) * (i < 3 ? translation_m : rotation_rad) / std::sqrt(3.0);
    keyframes[k].T_session_camera = keyframes[k].T_session_camera * geometry::isometryFromVector(motion);
  }
  return keyframes;
}

struct PoseError
{
  double translation_m = 0;  ///< largest of all keyframes
  double rotation_rad = 0;
};

inline PoseError largestError(const std::vector<Eigen::Isometry3d>& estimated, const std::vector<rgbd::Keyframe>& truth)
{
  PoseError error;
  for (std::size_t k = 0; k < truth.size(); ++k)
  {
    const Eigen::Isometry3d difference = truth[k].T_session_camera.inverse() * estimated[k];
    error.translation_m = std::max(error.translation_m, difference.translation().norm());
    error.rotation_rad = std::max(error.rotation_rad, geometry::rotationAngle_rad(difference));
  }
  return error;
}

}  // namespace object_modelling::refinement
