#pragma once

#include "scene_fixtures.h"

namespace object_modelling::segmentation
{
/// A box on a round table top that stands on the table, both turned by `turn_rad`; the camera stands still.
inline test_support::SceneImage turntableView(double turn_rad, std::uint64_t seed = 1, double height_m = 0.02,
                                              double diameter_m = 0.36)
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  test_support::SceneObject disc = test_support::standingCylinder(diameter_m, height_m);
  scene.objects[0].T_world_object.pretranslate(Eigen::Vector3d(0.03, 0, height_m));
  scene.objects.push_back(disc);
  for (test_support::SceneObject& object : scene.objects)
    object.T_world_object = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()) * object.T_world_object;
  test_support::SensorNoise noise = kinectNoise(seed);
  noise.missing_edge_px = 1;
  return test_support::renderScene(scene, test_support::vgaCamera(),
                                   test_support::orbitPose({ 0, 0, 0.05 }, 0.75, 0.4, 0.6), noise, 1000 + turn_rad);
}

/// Of `part`, the share that lies within `whole`.
inline double shareWithin(const cv::Mat& part, const cv::Mat& whole)
{
  return static_cast<double>(cv::countNonZero(part & whole)) / cv::countNonZero(part);
}

}  // namespace object_modelling::segmentation
