#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include "object_modelling/base/status.h"
#include "support/violations.h"
#include "tracking_scene.h"

namespace object_modelling::tracking
{
namespace
{
CameraTrackerOptions objectOptions()
{
  CameraTrackerOptions options;
  options.reference = Reference::OBJECT;
  return options;
}
}  // namespace

TEST(CameraTracker, FollowsAWalkWithinMillimeters)
{
  const TrackingScene scene(40);
  CameraTracker tracker;
  for (int i = 0; i < scene.size(); ++i)
  {
    const TrackingResult result = tracker.track(scene.frame(i));
    ASSERT_TRUE(result.tracked()) << i << ": " << result.reason;
    EXPECT_TRANSFORM_NEAR(result.T_session_camera, scene.truth(i), 0.003, 0.004) << i;
    EXPECT_GE(result.inlier_count, 20);
    EXPECT_GE(result.blur_ratio, 0);
    if (i > 0)
    {
      EXPECT_GT(result.covariance.diagonal().minCoeff(), 0);
    }
  }
}

TEST(CameraTracker, KeyframesHaveTheirDepthFromTheTimeOfTheirColor)
{
  // Back and up while turning: the depth of every pixel changes from frame to frame.
  const auto T_world_camera = [](double time_s) {
    return test_support::lookAt({ 0.5 + 0.3 * time_s, -0.1 + 0.3 * time_s, 0.5 + 0.2 * time_s }, { 0, 0, 0.05 });
  };
  const auto frame_at = [&](double time_s)
  {
    return test_support::renderFrame(test_support::boxOnTable(), TrackingScene::camera(), T_world_camera(time_s), {},
                                     time_s);
  };
  const auto median_mm = [](const cv::Mat& a_m, const cv::Mat& b_m)
  {
    std::vector<float> differences_mm;
    for (int i = 0; i < static_cast<int>(a_m.total()); ++i)
      if (const float difference = std::abs(a_m.at<float>(i) - b_m.at<float>(i)); std::isfinite(difference))
        differences_mm.push_back(1e3F * difference);
    const auto middle = differences_mm.begin() + static_cast<std::ptrdiff_t>(differences_mm.size() / 2);
    std::nth_element(differences_mm.begin(), middle, differences_mm.end());
    return *middle;
  };
  constexpr double DELAY_S = 0.015;
  CameraTracker tracker;
  int checked = 0;
  for (int i = 0; i < 30; ++i)
  {
    const rgbd::Frame truth = frame_at(i / 30.0);
    rgbd::Frame frame = truth;
    frame.depth_m = frame_at(i / 30.0 + DELAY_S).depth_m;
    frame.depth_delay_s = DELAY_S;
    const TrackingResult result = tracker.track(frame);
    ASSERT_TRUE(result.tracked()) << i << ": " << result.reason;
    if (!result.keyframe || i == 0)
      continue;
    EXPECT_EQ(result.keyframe->frame.depth_delay_s, 0);
    EXPECT_GT(median_mm(frame.depth_m, truth.depth_m), 4);
    EXPECT_LT(median_mm(result.keyframe->frame.depth_m, truth.depth_m), 0.4);
    ++checked;
  }
  EXPECT_GE(checked, 2);
}

TEST(CameraTracker, KeyframesShareLandmarksWhoseSightingsAreTrue)
{
  const TrackingScene scene(60, 0.9);
  CameraTracker tracker;
  std::vector<rgbd::Keyframe> keyframes;
  for (int i = 0; i < scene.size(); ++i)
    if (const TrackingResult result = tracker.track(scene.frame(i)); result.keyframe)
      keyframes.push_back(*result.keyframe);
  ASSERT_GE(keyframes.size(), 4u);
  std::map<std::uint64_t, std::vector<std::pair<const rgbd::Keyframe*, const rgbd::Observation*>>> tracks;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
  {
    EXPECT_EQ(keyframes[k].id, static_cast<int>(k));
    for (const rgbd::Observation& observation : keyframes[k].observations)
      tracks[observation.landmark_id].emplace_back(&keyframes[k], &observation);
  }
  int shared = 0;
  int wrong = 0;
  for (const auto& [id, track] : tracks)
  {
    const auto& [first, seen] = track.front();
    for (std::size_t k = 1; k < track.size(); ++k)
    {
      EXPECT_NE(track[k].first, track[k - 1].first) << "landmark " << id << " twice in one keyframe";
      const Eigen::Vector3d p_session =
          first->T_session_camera * first->frame.camera.unproject(seen->pixel.x(), seen->pixel.y(), seen->depth_m);
      const Eigen::Vector2d pixel =
          track[k].first->frame.camera.project(track[k].first->T_session_camera.inverse() * p_session);
      ++shared;
      wrong += (pixel - track[k].second->pixel.cast<double>()).norm() > 2.5;
    }
  }
  EXPECT_GT(shared, 100);
  EXPECT_LT(wrong, 0.03 * shared);
}

TEST(CameraTracker, SameFramesSameBytesWhateverTheThreads)
{
  const TrackingScene scene(25);
  const int threads = cv::getNumThreads();
  std::vector<TrackingResult> first;
  for (const int count : { 1, 4 })
  {
    cv::setNumThreads(count);
    CameraTracker tracker;
    for (int i = 0; i < scene.size(); ++i)
    {
      const TrackingResult result = tracker.track(scene.frame(i));
      if (count == 1)
      {
        first.push_back(result);
        continue;
      }
      EXPECT_EQ(result.T_session_camera.matrix(), first[i].T_session_camera.matrix()) << i;
      EXPECT_EQ(result.covariance, first[i].covariance) << i;
      EXPECT_EQ(result.keyframe.has_value(), first[i].keyframe.has_value()) << i;
    }
  }
  cv::setNumThreads(threads);
}

TEST(CameraTracker, ObjectModeFollowsTheObjectAlone)
{
  const TrackingScene scene(20, 0.3);
  CameraTracker tracker(objectOptions());
  for (int i = 0; i < scene.size(); ++i)
  {
    const rgbd::Frame frame = scene.frame(i);
    const TrackingResult result = tracker.track(frame);
    ASSERT_TRUE(result.tracked()) << i << ": " << result.reason;
    EXPECT_TRANSFORM_NEAR(result.T_session_camera, scene.truth(i), 0.006, 0.012) << i;
    if (result.keyframe)
    {
      for (const rgbd::Observation& observation : result.keyframe->observations)
        EXPECT_NE(
            frame.object_mask.at<std::uint8_t>(std::lround(observation.pixel.y()), std::lround(observation.pixel.x())),
            0);
    }
  }
}

TEST(CameraTracker, ObjectModePlacesAndKeepsEveryViewOfATurntable)
{
  const TrackingScene scene(8, 8 * 0.2, 6);
  CameraTracker tracker(objectOptions());
  Eigen::Isometry3d T_session_last = Eigen::Isometry3d::Identity();
  for (int i = 0; i < scene.size(); ++i)
  {
    const TrackingResult result = tracker.track(scene.frame(i));
    ASSERT_TRUE(result.tracked()) << i << ": " << result.reason;
    EXPECT_TRUE(result.keyframe) << i << ": " << result.reason;
    // From frame to frame: a small object seen small leaves its rotation to tenths of a pixel.
    if (i > 0)
    {
      EXPECT_TRANSFORM_NEAR(T_session_last.inverse() * result.T_session_camera,
                            scene.truth(i - 1).inverse() * scene.truth(i), 0.02, 0.03)
          << i;
    }
    T_session_last = result.T_session_camera;
  }
}

TEST(CameraTracker, ObjectModeFollowsWhatMovesWithTheObjectToo)
{
  const TrackingScene scene(8, 0.3);
  CameraTracker by_moving_mask(objectOptions()), by_object_mask(objectOptions());
  std::vector<rgbd::Keyframe> keyframes;
  const auto half = [](rgbd::Frame frame)
  {
    frame.moving_mask = frame.object_mask;
    frame.object_mask = frame.object_mask.clone();
    frame.object_mask.rowRange(0, frame.object_mask.rows / 2).setTo(0);
    return frame;
  };
  for (int i = 0; i < scene.size(); ++i)
  {
    const rgbd::Frame frame = half(scene.frame(i));
    const TrackingResult result = by_moving_mask.track(frame);
    ASSERT_TRUE(result.tracked()) << i << ": " << result.reason;
    EXPECT_EQ(result.T_session_camera.matrix(), by_object_mask.track(scene.frame(i)).T_session_camera.matrix()) << i;
    if (!result.keyframe)
      continue;
    keyframes.push_back(*result.keyframe);
    EXPECT_EQ(cv::countNonZero(result.keyframe->frame.object_mask), cv::countNonZero(frame.object_mask));
    EXPECT_EQ(cv::countNonZero(result.keyframe->frame.moving_mask), cv::countNonZero(frame.moving_mask));
  }
  CameraTracker resumed(objectOptions());
  resumed.resume(keyframes);
  EXPECT_EQ(resumed.track(half(scene.frame(0))).status, TrackingStatus::RELOCALISED);
}

TEST(CameraTracker, ObjectModeNeedsAMask)
{
  const TrackingScene scene(3);
  CameraTracker tracker(objectOptions());
  rgbd::Frame frame = scene.frame(0);
  frame.object_mask.release();
  const TrackingResult refused = tracker.track(frame);
  EXPECT_EQ(refused.status, TrackingStatus::NOT_STARTED);
  EXPECT_NE(refused.reason.find("mask"), std::string::npos);
  EXPECT_TRUE(tracker.track(scene.frame(1)).tracked());
  frame = scene.frame(2);
  frame.object_mask.setTo(0);
  EXPECT_EQ(tracker.track(frame).status, TrackingStatus::LOST);
}

TEST(CameraTracker, SceneModeTakesNoNoticeOfMasks)
{
  const TrackingScene scene(2);
  CameraTracker with, without;
  for (int i = 0; i < scene.size(); ++i)
  {
    rgbd::Frame frame = scene.frame(i);
    const TrackingResult masked = with.track(frame);
    frame.object_mask.release();
    EXPECT_EQ(masked.T_session_camera.matrix(), without.track(frame).T_session_camera.matrix());
    if (masked.keyframe)
    {
      EXPECT_FALSE(masked.keyframe->frame.object_mask.empty());
    }
  }
}

TEST(CameraTracker, RefusesOldStampsAndOtherSizesWithoutHarm)
{
  const TrackingScene scene(4);
  CameraTracker tracker;
  CameraTracker undisturbed;
  for (int i = 0; i < scene.size(); ++i)
  {
    const TrackingResult result = tracker.track(scene.frame(i));
    EXPECT_EQ(result.T_session_camera.matrix(), undisturbed.track(scene.frame(i)).T_session_camera.matrix());
    const TrackingResult again = tracker.track(scene.frame(i));
    EXPECT_EQ(again.status, TrackingStatus::LOST);
    EXPECT_NE(again.reason.find("not newer"), std::string::npos) << again.reason;
    rgbd::Frame other = scene.frame(i);
    other.stamp_s += 0.001;
    other.camera = test_support::vgaCamera();
    EXPECT_NE(tracker.track(other).reason.find("px"), std::string::npos);
  }
}

TEST(CameraTracker, DoesNotStartInTheDarkAndSaysWhy)
{
  const TrackingScene scene(2);
  CameraTracker tracker;
  const TrackingResult dark = tracker.track(covered(scene, 0));
  EXPECT_EQ(dark.status, TrackingStatus::NOT_STARTED);
  EXPECT_FALSE(dark.keyframe);
  EXPECT_FALSE(dark.reason.empty());
  const TrackingResult result = tracker.track(scene.frame(1));
  EXPECT_EQ(result.status, TrackingStatus::TRACKING);
  ASSERT_TRUE(result.keyframe);
  EXPECT_EQ(result.keyframe->id, 0);
}

TEST(CameraTracker, ResetBeginsANewSession)
{
  const TrackingScene scene(10);
  CameraTracker tracker;
  EXPECT_FALSE(tracker.predict(scene.stamp_s(0)));
  tracker.track(scene.frame(8));
  tracker.reset();
  EXPECT_FALSE(tracker.predict(scene.stamp_s(0)));
  const TrackingResult result = tracker.track(scene.frame(0));
  EXPECT_TRUE(result.tracked());
  EXPECT_TRUE(result.T_session_camera.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(CameraTracker, PredictsByConstantVelocity)
{
  const TrackingScene scene(12);
  CameraTracker tracker;
  for (int i = 0; i + 1 < scene.size(); ++i)
    tracker.track(scene.frame(i));
  const auto predicted = tracker.predict(scene.stamp_s(scene.size() - 1));
  ASSERT_TRUE(predicted);
  EXPECT_TRANSFORM_NEAR(*predicted, scene.truth(scene.size() - 1), 0.008, 0.015);
}

TEST(CameraTracker, ChecksItsOptions)
{
  CameraTrackerOptions options;
  options.min_inliers = 0;
  options.min_inlier_ratio = 2;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "min_inlier_ratio", "min_inliers" }));
  EXPECT_THROW(CameraTracker{ options }, base::Error);
}
}  // namespace object_modelling::tracking
