#pragma once

#include <utility>
#include <vector>

#include "object_modelling/tracking/camera_tracker.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::tracking
{
/// That cameras look at: the middle of what stands on the table.
inline const Eigen::Vector3d TARGET(0, 0, 0.08);

/// The sensor of these tests.
inline test_support::SensorNoise sensorNoise(int index)
{
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 0.5;
  noise.color_sigma = 1.5;
  noise.seed = static_cast<std::uint64_t>(index + 1);
  return noise;
}

/// No texture anywhere: a box and a can on a table, which look different from every side.
inline test_support::SyntheticScene plainScene()
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  scene.objects.push_back(test_support::standingCylinder(0.1, 0.08, 0.14, 0.1));
  scene.table = test_support::plainTexture();
  scene.objects[0].texture = test_support::plainTexture({ 90, 120, 200 });
  scene.objects[1].texture = test_support::plainTexture({ 120, 90, 60 });
  return scene;
}

/// A plain bar without end beside a plain box on a plain table: past the box, no telling how far along it.
inline test_support::SyntheticScene endlessBarScene()
{
  test_support::SyntheticScene scene = plainScene();
  scene.table_half_size_m = 8;
  scene.objects[1] = test_support::standingBox({ 0.1, 8, 0.15 }, -0.2, 0);
  scene.objects[1].texture = test_support::plainTexture({ 60, 90, 60 });
  return scene;
}

/// A walk round a textured box on a textured table, at a quarter of VGA so that a test takes seconds.
class TrackingScene
{
public:
  explicit TrackingScene(int frame_count, double turn_rad = 0.5, double rate_hz = 30,
                         test_support::SyntheticScene scene = test_support::boxOnTable())
      : scene_(std::move(scene))
  {
    test_support::HandheldOptions options;
    options.frame_count = frame_count;
    options.turn_rad = turn_rad;
    options.rate_hz = rate_hz;
    options.tremor_m = 0.002;
    options.tremor_rad = 0.003;
    cameras_ = test_support::handheldTrajectory(options);
  }

  int size() const { return static_cast<int>(cameras_.size()); }
  static geometry::PinholeCamera camera() { return test_support::vgaCamera().scaled(0.5); }
  rgbd::Frame frame(int index, const Eigen::Isometry3d& T_moved = Eigen::Isometry3d::Identity()) const
  {
    return test_support::renderFrame(scene_, camera(), cameras_[index].T_world_camera * T_moved, sensorNoise(index),
                                     cameras_[index].stamp_s);
  }
  /// Session frame: the first camera.
  Eigen::Isometry3d truth(int index) const
  {
    return cameras_[0].T_world_camera.inverse(Eigen::Isometry) * cameras_[index].T_world_camera;
  }
  double stamp_s(int index) const { return cameras_[index].stamp_s; }

private:
  test_support::SyntheticScene scene_;
  std::vector<test_support::StampedCamera> cameras_;
};

/// A frame in which a hand covers the lens.
inline rgbd::Frame covered(const TrackingScene& scene, int index)
{
  rgbd::Frame frame;
  frame.stamp_s = scene.stamp_s(index);
  frame.camera = TrackingScene::camera();
  const cv::Size size(frame.camera.width, frame.camera.height);
  frame.color_bgr = cv::Mat(size, CV_8UC3, cv::Scalar::all(3));
  frame.gray = cv::Mat(size, CV_8UC1, cv::Scalar(3));
  frame.depth_m = cv::Mat(size, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  return frame;
}

}  // namespace object_modelling::tracking
