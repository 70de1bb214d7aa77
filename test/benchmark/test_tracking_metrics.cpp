#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/transform_matchers.h"
#include "tracking_metrics.h"

namespace object_modelling::benchmark_tracking
{
namespace
{
using source::StampedPose;

Eigen::Isometry3d pose(double x, double y, double z, double angle_rad = 0)
{
  return geometry::isometryFrom(Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ())),
                                { x, y, z });
}

/// A camera that goes round in a circle of 1 m in 20 s, at 10 Hz.
std::vector<StampedPose> circle(int count = 200)
{
  std::vector<StampedPose> poses;
  for (int i = 0; i < count; ++i)
  {
    const double angle = i * 2 * M_PI / 200;
    poses.push_back({ 100 + 0.1 * i, pose(std::cos(angle), std::sin(angle), 0.1 * std::sin(3 * angle), angle) });
  }
  return poses;
}

std::vector<StampedPose> inOtherFrame(std::vector<StampedPose> poses, const Eigen::Isometry3d& T_map_world)
{
  for (StampedPose& stamped : poses)
    stamped.T_map_camera = T_map_world * stamped.T_map_camera;
  return poses;
}

std::vector<double> stampsOf(const std::vector<StampedPose>& poses)
{
  std::vector<double> stamps_s;
  for (const StampedPose& stamped : poses)
    stamps_s.push_back(stamped.stamp_s);
  return stamps_s;
}

const Eigen::Isometry3d T_MAP_WORLD =
    geometry::isometryFrom(Eigen::Quaterniond(0.7, -0.1, 0.5, 0.3), { 1.5, -2.0, 0.4 });

std::optional<TrajectoryScore> score(const std::vector<StampedPose>& estimate, const std::vector<StampedPose>& truth,
                                     const std::vector<Event>& events = {})
{
  return scoreTrajectory(estimate, truth, events, stampsOf(truth));
}

TEST(TrajectoryScore, IsZeroForTheTruthInAnotherFrame)
{
  const auto result = score(inOtherFrame(circle(), T_MAP_WORLD), circle());
  ASSERT_TRUE(result);
  EXPECT_EQ(result->matched, 200);
  EXPECT_EQ(result->wrong, 0);
  EXPECT_NEAR(result->ate_mm.max, 0, 1e-9);
  EXPECT_NEAR(result->rotation_deg.max, 0, 1e-6);
  ASSERT_TRUE(result->rpe_mm);
  EXPECT_NEAR(result->rpe_mm->max, 0, 1e-9);
  EXPECT_TRANSFORM_NEAR(result->pairs[7].T_world_camera, circle()[7].T_map_camera, 1e-12, 1e-9);
}

TEST(TrajectoryScore, GivesTheErrorsOfAlternatingOffsets)
{
  // 3 mm up and down along z, where alignment cannot take it away: neighbours by 10 frames have the same sign.
  std::vector<StampedPose> estimate = circle();
  for (std::size_t i = 0; i < estimate.size(); ++i)
    estimate[i].T_map_camera.translation().z() += i % 2 == 0 ? 0.003 : -0.003;
  const auto result = score(inOtherFrame(estimate, T_MAP_WORLD), circle());
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->ate_mm.rmse, 3, 1e-2);
  EXPECT_NEAR(result->ate_mm.max, 3, 0.1);
  EXPECT_NEAR(result->rpe_mm->max, 0, 1e-9);
}

TEST(TrajectoryScore, GivesDriftPerSecondOfAScaledLine)
{
  // 1 % too far along a line at 0.2 m/s: 2 mm/s, and a roll about it of 0.01 rad/s.
  std::vector<StampedPose> truth, estimate;
  for (int i = 0; i < 101; ++i)
  {
    truth.push_back({ 0.1 * i, pose(0.02 * i, 0, 0) });
    estimate.push_back({ 0.1 * i, pose(1.01 * 0.02 * i, 0, 0) });
    estimate.back().T_map_camera.rotate(Eigen::AngleAxisd(0.001 * i, Eigen::Vector3d::UnitX()));
  }
  const auto result = score(estimate, truth);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->rpe_mm->mean, 2, 1e-9);
  EXPECT_NEAR(result->rpe_deg->mean, 0.01 * 180 / M_PI, 1e-9);
}

TEST(TrajectoryScore, TellsMinutesApart)
{
  // Two minutes without error, one with 5 mm to and fro, none, and half a minute without again.
  const std::vector<StampedPose> truth = circle(2700);
  std::vector<StampedPose> estimate;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (i < 1800 || i >= 2400)
      estimate.push_back({ truth[i].stamp_s, truth[i].T_map_camera });
  for (std::size_t i = 1200; i < 1800; ++i)
    estimate[i].T_map_camera.translation().z() += i % 2 == 0 ? 0.005 : -0.005;
  const auto result = score(estimate, truth);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->ate_by_minute_mm.size(), 4u);
  const double expected_mm[] = { 0, 0, 5, 0 };
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(result->ate_by_minute_mm[i], expected_mm[i], 0.05) << i;
}

TEST(TrajectoryScore, DoesNotScale)
{
  std::vector<StampedPose> estimate = circle();
  for (StampedPose& stamped : estimate)
    stamped.T_map_camera.translation() *= 1.01;
  const auto result = score(estimate, circle());
  ASSERT_TRUE(result);
  EXPECT_GT(result->ate_mm.rmse, 9.9);
}

TEST(TrajectoryScore, NeedsThreePoses)
{
  EXPECT_FALSE(score(circle(2), circle()));
  EXPECT_FALSE(score({}, circle()));
  EXPECT_FALSE(score(circle(), {}));
  EXPECT_TRUE(score(circle(3), circle()));
}

TEST(TrajectoryScore, CountsWrongPosesAndFramesAfterAnEvent)
{
  const std::vector<StampedPose> truth = circle();
  const std::vector<Event> events = { { "cover", 105, 107 }, { "away", 112, 113 } };
  std::vector<StampedPose> estimate;
  for (const StampedPose& stamped : truth)
  {
    const double stamp_s = stamped.stamp_s;
    if ((stamp_s > 104.95 && stamp_s < 107.25) || stamp_s > 111.95)
      continue;
    estimate.push_back(stamped);
    if (stamp_s > 107.25 && stamp_s < 107.45)
      estimate.back().T_map_camera.translation().x() += 0.1;
  }
  const auto result = score(estimate, truth, events);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->wrong, 2);
  ASSERT_EQ(result->relocalisations.size(), 2u);
  EXPECT_EQ(result->relocalisations[0].frames_to_pose, 3);
  EXPECT_EQ(result->relocalisations[0].frames_to_right_pose, 5);
  EXPECT_FALSE(result->relocalisations[1].frames_to_pose);
}

TEST(TrajectoryScore, AlignsBeforeTheFirstEvent)
{
  std::vector<StampedPose> estimate = circle();
  for (std::size_t i = 100; i < estimate.size(); ++i)
    estimate[i].T_map_camera.translation().x() += 0.05;
  const auto result = score(estimate, circle(), { { "cover", 109.05, 109.95 } });
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->pairs[50].position_mm, 0, 1e-9);
  EXPECT_NEAR(result->pairs[150].position_mm, 50, 1e-9);
  EXPECT_EQ(result->wrong, 100);
}

TEST(Associate, PairsMutuallyNearestStamps)
{
  const std::vector<StampedPose> a = { { 1.0, {} }, { 2.0, {} }, { 3.0, {} } };
  const std::vector<StampedPose> b = { { 0.99, {} }, { 1.005, {} }, { 2.5, {} }, { 3.01, {} } };
  const auto pairs = associate(a, b, 0.02);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], std::make_pair(std::size_t(0), std::size_t(1)));
  EXPECT_EQ(pairs[1], std::make_pair(std::size_t(2), std::size_t(3)));
}

TEST(Statistics, OfAnEvenCount)
{
  const Statistics result = statisticsOf({ 4, 1, 3, 2 });
  EXPECT_DOUBLE_EQ(result.median, 2.5);
  EXPECT_DOUBLE_EQ(result.mean, 2.5);
  EXPECT_DOUBLE_EQ(result.max, 4);
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt(7.5));
}

/// Estimates off by exactly `sigmas` standard deviations along x, in a frame of their own.
std::vector<EstimateWithCovariance> offBy(double sigmas)
{
  std::vector<EstimateWithCovariance> estimate;
  geometry::Matrix6d covariance = geometry::Matrix6d::Identity() * 1e-6;
  covariance(0, 0) = 4e-6;
  for (const StampedPose& stamped : circle())
    estimate.push_back({ { stamped.stamp_s, T_MAP_WORLD * stamped.T_map_camera }, covariance });
  for (std::size_t i = 1; i < estimate.size(); ++i)
    estimate[i].pose.T_map_camera.translation().x() += 0.002 * sigmas;
  estimate.front().covariance.setZero();
  return estimate;
}

TEST(Nees, IsTheSquareOfTheSigmas)
{
  // The error is in the map's frame: x there is not x of the world.
  const Nees result = neesOf(offBy(3), circle(), 0.02);
  EXPECT_EQ(result.count, 199);
  EXPECT_NEAR(result.median, 9, 1e-6);
  EXPECT_DOUBLE_EQ(result.within_ratio, 1);
  EXPECT_DOUBLE_EQ(neesOf(offBy(3.54), circle(), 0.02).within_ratio, 1);
  EXPECT_DOUBLE_EQ(neesOf(offBy(3.56), circle(), 0.02).within_ratio, 0);
}

TEST(Nees, CountsUnusableCovariancesAsOutside)
{
  std::vector<EstimateWithCovariance> estimate = offBy(0);
  estimate[1].covariance(2, 2) = -1e-6;
  estimate[2].covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const Nees result = neesOf(estimate, circle(), 0.02);
  EXPECT_EQ(result.count, 199);
  EXPECT_DOUBLE_EQ(result.within_ratio, 197.0 / 199);
}

TEST(Nees, CountsNothingWithoutTruth)
{
  EXPECT_EQ(neesOf(offBy(1), {}, 0.02).count, 0);
}

}  // namespace
}  // namespace object_modelling::benchmark_tracking
