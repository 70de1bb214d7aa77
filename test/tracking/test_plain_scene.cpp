#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tracking_scene.h"

// Scenes without texture: what tracking has is shape and shade. And where even these do not tell the motion, a robot
// may.
namespace object_modelling::tracking
{
namespace
{

/// The largest error of a pose in standard deviations of its own covariance, over the six axes.
double errorSigmas(const TrackingResult& result, const Eigen::Isometry3d& T_session_camera)
{
  const geometry::Vector6d error = geometry::vectorFromIsometry(result.T_session_camera * T_session_camera.inverse());
  return (error.array() / result.covariance.diagonal().array().max(1e-12).sqrt()).abs().maxCoeff();
}

/// Frames of a scene from given poses, `interval_s` apart; the session frame is the first camera.
struct Sequence
{
  rgbd::Frame frame(int i) const
  {
    return test_support::renderFrame(scene, TrackingScene::camera(), T_world_cameras[i], sensorNoise(i),
                                     5 + interval_s * i);
  }
  Eigen::Isometry3d truth(int i) const { return T_world_cameras[0].inverse() * T_world_cameras[i]; }
  int size() const { return static_cast<int>(T_world_cameras.size()); }

  test_support::SyntheticScene scene;
  double interval_s = 1 / 30.0;
  std::vector<Eigen::Isometry3d> T_world_cameras;
};

/// From the objects to the bare table, which has no end, within a second; there to and fro for another.
Sequence turnToBareWall(const test_support::SyntheticScene& scene)
{
  Sequence turn;
  turn.scene = scene;
  turn.scene.table_half_size_m = 8;
  for (int i = 0; i < 60; ++i)
  {
    const double away = std::clamp((i - 8) / 30.0, 0.0, 1.0);
    turn.T_world_cameras.push_back(
        test_support::lookAt({ 0.7 + 0.02 * std::sin(0.3 * i), -0.1, 0.6 }, { 0.0, 1.6 * away, 0.05 }));
  }
  return turn;
}

/// Looks half a second apart, to and fro and rolled: no velocity foretells the next.
Sequence jumps(const test_support::SyntheticScene& scene)
{
  Sequence jumps;
  jumps.scene = scene;
  jumps.interval_s = 0.5;
  const double azimuths_rad[] = { 0.0, 0.2, 0.0, 0.3, 0.1, 0.4, 0.25, 0.05, 0.35, 0.5 };
  const double rolls_rad[] = { 0.0, 1.9, -0.5, -2.2, 0.2, 2.4, 0.1, -2.0, 0.4, -1.6 };
  for (int i = 0; i < 10; ++i)
  {
    geometry::Vector6d roll = geometry::Vector6d::Zero();
    roll(5) = rolls_rad[i];
    jumps.T_world_cameras.push_back(test_support::orbitPose(TARGET, 0.6, azimuths_rad[i], 0.6) *
                                    geometry::isometryFromVector(roll));
  }
  return jumps;
}

/// What a robot says whose base stands somewhere else, with an error of millimetres.
Eigen::Isometry3d robotPose(const Sequence& sequence, int i)
{
  geometry::Vector6d base, error;
  base << 1.2, -0.7, -0.4, 0.6, -0.3, 2.1;
  error << 0.002 * std::sin(3.0 * i), 0.002 * std::cos(5.0 * i), 0.001, 0.004 * std::sin(7.0 * i), 0.002, -0.003;
  return geometry::isometryFromVector(base) * sequence.T_world_cameras[i] * geometry::isometryFromVector(error);
}

/// Expects a camera that goes on until it no longer knows where it is, and says why. Gives the reasons.
std::string expectHonestLoss(const Sequence& sequence, int last_must_track, int first_must_not)
{
  std::string reasons;
  CameraTracker tracker;
  for (int i = 0; i < sequence.size(); ++i)
  {
    const TrackingResult result = tracker.track(sequence.frame(i));
    if (i <= last_must_track)
    {
      EXPECT_EQ(result.status, TrackingStatus::TRACKING) << i << ": " << result.reason;
    }
    if (i >= first_must_not)
    {
      EXPECT_EQ(result.status, TrackingStatus::LOST) << i;
    }
    if (result.tracked() && i > 0)
    {
      EXPECT_LT(errorSigmas(result, sequence.truth(i)), 5) << i;
    }
    if (result.status != TrackingStatus::LOST)
      continue;
    EXPECT_FALSE(result.reason.empty()) << i;
    reasons += result.reason + "\n";
  }
  return reasons;
}

int trackedWithin(const Sequence& sequence, bool by_robot, double meters, double radians)
{
  int good = 0;
  CameraTracker tracker;
  for (int i = 0; i < sequence.size(); ++i)
  {
    const std::optional<Eigen::Isometry3d> T_robot_camera =
        by_robot ? std::make_optional(robotPose(sequence, i)) : std::nullopt;
    const TrackingResult result = tracker.track(sequence.frame(i), T_robot_camera);
    const Eigen::Isometry3d T_error = sequence.truth(i).inverse() * result.T_session_camera;
    good += result.status == TrackingStatus::TRACKING && T_error.translation().norm() < meters &&
            geometry::rotationAngle_rad(T_error) < radians;
  }
  return good;
}

}  // namespace

TEST(PlainScene, IsTrackedByShapeAndShade)
{
  const TrackingScene scene(60, 0.9, 30, plainScene());
  CameraTracker tracker;
  int good = 0;
  for (int i = 0; i < scene.size(); ++i)
  {
    const TrackingResult result = tracker.track(scene.frame(i));
    const Eigen::Isometry3d T_error = scene.truth(i).inverse() * result.T_session_camera;
    good += result.tracked() && T_error.translation().norm() < 0.01;
    if (result.tracked() && i > 0)
    {
      EXPECT_LT(errorSigmas(result, scene.truth(i)), 5) << i;
    }
  }
  EXPECT_GE(good, 0.95 * scene.size());
}

TEST(PlainScene, BareWallEndsTheTrackingInsteadOfLeadingItAstray)
{
  test_support::SyntheticScene printed_box = plainScene();
  printed_box.objects[0].texture = test_support::boxOnTable().objects[0].texture;
  for (const test_support::SyntheticScene& scene : { plainScene(), printed_box })
  {
    const std::string reasons = expectHonestLoss(turnToBareWall(scene), 15, 40);
    EXPECT_NE(reasons.find("plain"), std::string::npos) << reasons;
  }
}

TEST(PlainScene, EndlessBarLeavesADirectionFree)
{
  Sequence along;
  along.scene = endlessBarScene();
  for (int i = 0; i < 50; ++i)
  {
    const double y_m = 0.025 * std::clamp(i - 5, 0, 25);  // past the box, then the camera stands still
    along.T_world_cameras.push_back(test_support::lookAt({ 0.5, y_m, 0.6 }, { -0.1, y_m, 0.05 }));
  }
  const std::string reasons = expectHonestLoss(along, 10, 45);
  EXPECT_NE(reasons.find("direction free"), std::string::npos) << reasons;
}

TEST(PlainScene, CoveredLensIsRelocalisedBySurfaces)
{
  const TrackingScene scene(26, 0.4, 30, plainScene());
  CameraTracker tracker;
  for (int i = 0; i < scene.size(); ++i)
  {
    const bool hidden = i >= 12 && i < 20;
    const TrackingResult result = tracker.track(hidden ? covered(scene, i) : scene.frame(i));
    const TrackingStatus expected = hidden    ? TrackingStatus::LOST
                                    : i == 20 ? TrackingStatus::RELOCALISED
                                              : TrackingStatus::TRACKING;
    ASSERT_EQ(result.status, expected) << i << ": " << result.reason;
    if (!hidden)
    {
      EXPECT_TRANSFORM_NEAR(result.T_session_camera, scene.truth(i), 0.006, 0.008) << i;
    }
  }
}

/// A walk round a plain box on a plain table without end, and the looks that follow when it is lost.
class PlainBoxWalk : public testing::Test
{
protected:
  /// Tracks a walk over `turn_rad`, then covers the lens.
  void walk(const Eigen::Vector3d& size_m, double turn_rad)
  {
    round_.scene = plainScene();
    round_.scene.table_half_size_m = 8;
    round_.scene.objects = { test_support::standingBox(size_m) };
    round_.scene.objects[0].texture = test_support::plainTexture({ 90, 120, 200 });
    for (double azimuth_rad = 0; azimuth_rad < turn_rad; azimuth_rad += 0.03)
      ASSERT_EQ(look(azimuth_rad, 1 / 30.0).status, TrackingStatus::TRACKING) << azimuth_rad;
    const TrackingScene any(1);
    rgbd::Frame dark = covered(any, 0);
    for (int i = 0; i < 3; ++i)
    {
      dark.stamp_s = stamp_s_ += 0.2;
      ASSERT_EQ(tracker_.track(dark).status, TrackingStatus::LOST) << i;
    }
  }
  TrackingResult look(double azimuth_rad, double after_s)
  {
    round_.T_world_cameras.push_back(test_support::orbitPose(TARGET, 0.6, azimuth_rad, 0.6));
    rgbd::Frame frame = round_.frame(round_.size() - 1);
    frame.stamp_s = stamp_s_ += after_s;
    return tracker_.track(frame);
  }
  Eigen::Isometry3d truth() const { return round_.truth(round_.size() - 1); }

  Sequence round_;
  CameraTracker tracker_;
  double stamp_s_ = 5;
};

TEST_F(PlainBoxWalk, OtherSideIsNotTakenForTheKnownOne)
{
  walk({ 0.22, 0.12, 0.15 }, 1.2);
  // Opposite to where the walk began.
  const TrackingResult refused = look(M_PI, 1);
  EXPECT_EQ(refused.status, TrackingStatus::LOST);
  EXPECT_NE(refused.reason.find("go back to where it was lost"), std::string::npos) << refused.reason;
  const TrackingResult found = look(1.14, 1);
  EXPECT_EQ(found.status, TrackingStatus::RELOCALISED) << found.reason;
  EXPECT_TRANSFORM_NEAR(found.T_session_camera, truth(), 0.01, 0.015);
}

TEST_F(PlainBoxWalk, SideOfASquareBoxIsFoundAgainWhereItWasLost)
{
  walk({ 0.15, 0.15, 0.15 }, 2.08);
  for (const double azimuth_rad : { 2.07, 2.05 })
  {
    const TrackingResult found = look(azimuth_rad, 0.5);
    ASSERT_TRUE(found.tracked()) << found.reason;
    EXPECT_TRANSFORM_NEAR(found.T_session_camera, truth(), 0.015, 0.02);
  }
}

TEST(RobotMotion, CarriesTheTrackingWhereVelocityDoesNot)
{
  for (const test_support::SyntheticScene& scene : { plainScene(), test_support::boxOnTable() })
  {
    const Sequence sequence = jumps(scene);
    EXPECT_EQ(trackedWithin(sequence, true, 0.005, 0.008), sequence.size());
  }
  // Print is recognised from anywhere, shape is not.
  EXPECT_LT(trackedWithin(jumps(plainScene()), false, 0.005, 0.008), 8);
}

TEST(RobotMotion, ALieDoesNotMoveTheCameraBeforePrint)
{
  for (int axis = 0; axis < 3; ++axis)
    for (const double lie_m : { -0.3, 0.3 })
    {
      const TrackingScene walk(11, 0.2);
      CameraTracker tracker;
      for (int i = 0; i < walk.size(); ++i)
      {
        Eigen::Isometry3d T_lie = Eigen::Isometry3d::Identity();
        if (i >= 8)
          T_lie.translation()(axis) = lie_m * (i - 7);
        const TrackingResult result = tracker.track(walk.frame(i), walk.truth(i) * T_lie);
        if (result.tracked())
        {
          EXPECT_TRANSFORM_NEAR(result.T_session_camera, walk.truth(i), 0.003, 0.004) << i;
        }
        if (result.tracked() && i > 0)
        {
          EXPECT_LT(errorSigmas(result, walk.truth(i)), 5) << i;
        }
      }
    }
}

TEST(RobotMotion, OnlyMotionCountsNotWhereTheRobotStands)
{
  const TrackingScene walk(10, 0.15);
  CameraTracker at_home, elsewhere, alone;
  geometry::Vector6d x;
  x << 0.8, -0.8, 0.4, 0.8, 0.6, -1;
  const Eigen::Isometry3d T_far = geometry::isometryFromVector(x);
  for (int i = 0; i < walk.size(); ++i)
  {
    const TrackingResult a = at_home.track(walk.frame(i), walk.truth(i));
    const TrackingResult b = elsewhere.track(walk.frame(i), T_far * walk.truth(i));
    // A robot that says nothing now and then is as good as none.
    const TrackingResult c = alone.track(walk.frame(i), i % 3 == 0 ? std::make_optional(walk.truth(i)) : std::nullopt);
    EXPECT_TRANSFORM_NEAR(a.T_session_camera, b.T_session_camera, 1e-5, 1e-5) << i;
    for (const TrackingResult& result : { a, b, c })
    {
      ASSERT_TRUE(result.tracked()) << i << ": " << result.reason;
      EXPECT_TRANSFORM_NEAR(result.T_session_camera, walk.truth(i), 0.003, 0.004) << i;
    }
  }
}
TEST(RobotMotion, ALieDoesNotMoveTheCameraBeforePlainThings)
{
  for (int axis = 0; axis < 3; ++axis)
    for (const double lie_m : { -0.3, 0.3 })
    {
      const TrackingScene walk(11, 0.2, 30, plainScene());
      CameraTracker tracker;
      for (int i = 0; i < walk.size(); ++i)
      {
        Eigen::Isometry3d T_lie = Eigen::Isometry3d::Identity();
        T_lie.translation()(axis) = lie_m * std::max(0, i - 7);
        const TrackingResult result = tracker.track(walk.frame(i), walk.truth(i) * T_lie);
        if (result.tracked() && i > 0)
        {
          EXPECT_LT(errorSigmas(result, walk.truth(i)), 5) << axis << ", " << lie_m << " m, " << i;
        }
      }
    }
}

}  // namespace object_modelling::tracking
