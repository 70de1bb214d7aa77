#include "landmark_map.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
constexpr int LANDMARKS = 60;

/// Keyframes round the origin, each of which sees every landmark.
std::vector<rgbd::Keyframe> keyframesThatSeeAll(int count)
{
  std::vector<rgbd::Keyframe> keyframes(count);
  for (int k = 0; k < count; ++k)
  {
    rgbd::Keyframe& keyframe = keyframes[k];
    keyframe.id = k;
    keyframe.frame.camera = test_support::vgaCamera();
    keyframe.T_session_camera = test_support::orbitPose(Eigen::Vector3d::Zero(), 0.6, 2 * M_PI * k / count, 0.6);
    for (int i = 0; i < LANDMARKS; ++i)
    {
      const Eigen::Vector3d p_session(0.001 * i, 0.002 * (i % 7), 0.003 * (i % 11));
      const Eigen::Vector3d p_camera = keyframe.T_session_camera.inverse() * p_session;
      rgbd::Observation observation;
      observation.landmark_id = static_cast<std::uint64_t>(i + 1);
      observation.pixel = keyframe.frame.camera.project(p_camera).cast<float>();
      observation.depth_m = static_cast<float>(p_camera.z());
      keyframe.observations.push_back(observation);
    }
  }
  return keyframes;
}

LandmarkMap mapOf(const std::vector<rgbd::Keyframe>& keyframes)
{
  std::vector<Eigen::Isometry3d> poses;
  for (const rgbd::Keyframe& keyframe : keyframes)
    poses.push_back(keyframe.T_session_camera);
  return placeLandmarks(trackedSights(keyframes, 0.5, false), keyframes, poses, 2);
}

TEST(LandmarkMap, KeepsAllSightsOfAnOrdinarySession)
{
  const LandmarkMap map = mapOf(keyframesThatSeeAll(30));
  EXPECT_EQ(map.landmarks.size(), static_cast<std::size_t>(LANDMARKS));
  EXPECT_EQ(map.sights.size(), static_cast<std::size_t>(30 * LANDMARKS));
}

TEST(LandmarkMap, KeepsSomeOfManySightsEvenlyAndEveryKeyframe)
{
  constexpr int COUNT = 200;
  const LandmarkMap map = mapOf(keyframesThatSeeAll(COUNT));
  std::map<int, std::vector<int>> keyframes_of_landmark;
  std::vector<int> sights_of_keyframe(COUNT, 0);
  for (const Sight& sight : map.sights)
  {
    keyframes_of_landmark[sight.landmark].push_back(sight.keyframe);
    ++sights_of_keyframe[sight.keyframe];
  }
  ASSERT_EQ(keyframes_of_landmark.size(), static_cast<std::size_t>(LANDMARKS));
  for (const auto& [landmark, keyframes] : keyframes_of_landmark)
  {
    ASSERT_EQ(keyframes.size(), 30u) << landmark;
    for (std::size_t i = 1; i < keyframes.size(); ++i)
      EXPECT_NEAR(keyframes[i] - keyframes[i - 1], COUNT / 30.0, 1) << landmark;
  }
  // Evenly each had 9.
  EXPECT_GE(*std::min_element(sights_of_keyframe.begin(), sights_of_keyframe.end()), 6);
}

}  // namespace
}  // namespace object_modelling::bundle_adjustment
