#pragma once

#include <vector>

#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::multi_view_icp
{
/// Objects without texture on a table without texture that goes on beyond every view.
inline test_support::SyntheticScene plainScene(const std::vector<test_support::SceneObject>& objects)
{
  test_support::SyntheticScene scene;
  scene.table_half_size_m = 5;
  scene.table = test_support::plainTexture();
  for (test_support::SceneObject object : objects)
  {
    object.texture = test_support::plainTexture({ 90, 120, 200 });
    scene.objects.push_back(object);
  }
  return scene;
}

inline test_support::SensorNoise sensorNoise()
{
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 1;
  noise.missing_edge_px = 1;
  noise.color_sigma = 2;
  return noise;
}

/// Views all the way round, at 320 x 240 px, with exact poses.
inline std::vector<rgbd::View> viewsRound(const test_support::SyntheticScene& scene, int count)
{
  return test_support::renderViews(scene, test_support::vgaCamera().scaled(0.5),
                                   test_support::orbitPoses(count, { 0, 0, 0.08 }, 0.6), sensorNoise());
}

}  // namespace object_modelling::multi_view_icp
