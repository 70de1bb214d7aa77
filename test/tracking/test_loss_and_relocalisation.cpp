#include <gtest/gtest.h>

#include "object_modelling/base/status.h"
#include "tracking_scene.h"

namespace object_modelling::tracking
{
TEST(Loss, CoveredLensIsLostThenRelocalised)
{
  const TrackingScene scene(30);
  CameraTracker tracker;
  for (int i = 0; i < scene.size(); ++i)
  {
    const bool hidden = i >= 12 && i < 18;
    const TrackingResult result = tracker.track(hidden ? covered(scene, i) : scene.frame(i));
    const TrackingStatus expected = hidden    ? TrackingStatus::LOST
                                    : i == 18 ? TrackingStatus::RELOCALISED
                                              : TrackingStatus::TRACKING;
    ASSERT_EQ(result.status, expected) << i << ": " << result.reason;
    EXPECT_EQ(result.reason.empty(), result.status == TrackingStatus::TRACKING) << result.reason;
    if (!hidden)
    {
      EXPECT_TRANSFORM_NEAR(result.T_session_camera, scene.truth(i), 0.004, 0.006) << i;
    }
  }
}

TEST(Loss, RelocalisesFromWhereItWasBeforeWhateverTheWay)
{
  const TrackingScene scene(30);
  CameraTracker tracker;
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(tracker.track(scene.frame(i)).tracked());
  tracker.track(covered(scene, 20));
  // The camera comes back where it began, half a second later.
  rgbd::Frame frame = scene.frame(2);
  frame.stamp_s = scene.stamp_s(29);
  const TrackingResult result = tracker.track(frame);
  ASSERT_EQ(result.status, TrackingStatus::RELOCALISED) << result.reason;
  EXPECT_TRANSFORM_NEAR(result.T_session_camera, scene.truth(2), 0.004, 0.006);
}

TEST(Loss, AnotherSceneIsNeverRecognised)
{
  const TrackingScene scene(20);
  CameraTracker tracker;
  for (int i = 0; i < 10; ++i)
    tracker.track(scene.frame(i));
  test_support::SyntheticScene other = test_support::boxOnTable();
  other.table.seed += 100;
  for (test_support::SceneObject& object : other.objects)
    object.texture.seed += 100;
  for (int i = 10; i < 15; ++i)
  {
    const TrackingResult result = tracker.track(test_support::renderFrame(
        other, TrackingScene::camera(), test_support::orbitPose({ 0, 0, 0.08 }, 0.7, 0.2, 0.6), {}, scene.stamp_s(i)));
    EXPECT_EQ(result.status, TrackingStatus::LOST) << i;
    EXPECT_FALSE(result.reason.empty());
    EXPECT_FALSE(result.keyframe);
  }
}

TEST(Resume, FirstFrameRelocalisesInTheStoredMap)
{
  const TrackingScene scene(40);
  std::vector<rgbd::Keyframe> keyframes;
  {
    CameraTracker tracker;
    for (int i = 0; i < 30; ++i)
      if (const TrackingResult result = tracker.track(scene.frame(i)); result.keyframe)
        keyframes.push_back(*result.keyframe);
  }
  CameraTracker resumed;
  resumed.resume(keyframes);
  EXPECT_EQ(resumed.track(covered(scene, 30)).status, TrackingStatus::LOST);
  for (int i = 31; i < scene.size(); ++i)
  {
    const TrackingResult result = resumed.track(scene.frame(i));
    ASSERT_EQ(result.status, i == 31 ? TrackingStatus::RELOCALISED : TrackingStatus::TRACKING) << result.reason;
    EXPECT_TRANSFORM_NEAR(result.T_session_camera, scene.truth(i), 0.005, 0.008) << i;
    if (result.keyframe)
    {
      EXPECT_GE(result.keyframe->id, static_cast<int>(keyframes.size()));
    }
  }
}

TEST(Resume, RefusesFramesOfAnotherCamera)
{
  const TrackingScene scene(2);
  CameraTracker tracker;
  const TrackingResult first = tracker.track(scene.frame(0));
  ASSERT_TRUE(first.keyframe);
  tracker.resume({ *first.keyframe });
  rgbd::Frame frame = scene.frame(1);
  frame.camera.fx += 10;
  const TrackingResult refused = tracker.track(frame);
  EXPECT_EQ(refused.status, TrackingStatus::LOST);
  EXPECT_NE(refused.reason.find("intrinsics"), std::string::npos) << refused.reason;
}

TEST(Resume, RefusesKeyframesWithoutImages)
{
  CameraTracker tracker;
  EXPECT_THROW(tracker.resume({ rgbd::Keyframe() }), base::Error);
}

TEST(Resume, SkipsObservationsOutsideTheImage)
{
  const TrackingScene scene(2);
  CameraTracker tracker;
  rgbd::Keyframe keyframe = *tracker.track(scene.frame(0)).keyframe;
  keyframe.observations.push_back({ 99999, { 1e6F, -4.0F }, 1.0F });
  tracker.resume({ keyframe });
  EXPECT_EQ(tracker.track(scene.frame(1)).status, TrackingStatus::RELOCALISED);
}
}  // namespace object_modelling::tracking
