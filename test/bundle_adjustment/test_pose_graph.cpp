#include "pose_graph.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/handheld_trajectory.h"
#include "support/transform_matchers.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
const Eigen::Vector3d AT_1M(0.1, -0.05, 1);
constexpr double RADIUS_M = 0.1;
constexpr double AT_THE_MINIMUM = 5e-4;  // m and rad: the solver ends where the cost stays within 1e-6

PoseEdge edgeOf(int a, int b, const Eigen::Isometry3d& T_a_b, double sigma_m = 0.004)
{
  PoseEdge edge;
  edge.a = a;
  edge.b = b;
  edge.T_a_b = T_a_b;
  edge.points_b = patchCorners(AT_1M, RADIUS_M);
  edge.sigma_m = sigma_m;
  return edge;
}

Eigen::Isometry3d translated(double x_m, double y_m = 0, double z_m = 0)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x_m, y_m, z_m));
}

TEST(PatchCorners, HaveTheCenterAndTheSameSpreadInAllDirections)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : patchCorners(AT_1M, RADIUS_M))
  {
    EXPECT_NEAR((p - AT_1M).norm(), RADIUS_M, 1e-12);
    sum += p;
    squares += (p - AT_1M) * (p - AT_1M).transpose();
  }
  EXPECT_TRUE(sum.isApprox(4 * AT_1M, 1e-12));
  EXPECT_TRUE(squares.isApprox(4 * RADIUS_M * RADIUS_M / 3 * Eigen::Matrix3d::Identity(), 1e-9)) << squares;
}

TEST(EdgeError, IsHowFarThePointsComeApart)
{
  const Eigen::Isometry3d T_session_a = test_support::orbitPose({ 0, 0, 0 }, 0.7, 0.3, 0.5);
  const Eigen::Isometry3d T_a_b = translated(0.1, 0.05) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY());
  const PoseEdge edge = edgeOf(1, 0, T_a_b);
  const auto error_m = [&](const Eigen::Isometry3d& T_off) {
    return edgeError_m(edge, { T_session_a * T_a_b * T_off, T_session_a });
  };
  EXPECT_NEAR(error_m(Eigen::Isometry3d::Identity()), 0, 1e-12);
  EXPECT_NEAR(error_m(translated(0.03, 0, 0.04)), 0.05, 1e-12);
  // About the patch's centre its points move by their distance from the axis, whose mean square is 2 r^2 / 3.
  const Eigen::AngleAxisd turn(0.2, Eigen::Vector3d(1, -2, 1).normalized());
  const double arc_m = 2 * std::sin(0.1) * RADIUS_M * std::sqrt(2.0 / 3);
  EXPECT_NEAR(error_m(Eigen::Translation3d(AT_1M) * turn * Eigen::Translation3d(-AT_1M)), arc_m, 1e-9);
  // About the camera the centre moves too.
  const double lever_m = (turn * AT_1M - AT_1M).norm();
  EXPECT_NEAR(error_m(Eigen::Isometry3d(turn)), std::hypot(arc_m, lever_m), 1e-9);
}

TEST(RelaxPoseGraph, FindsThePosesOfEdgesThatAgree)
{
  constexpr int COUNT = 8;
  const std::vector<Eigen::Isometry3d> truth = test_support::orbitPoses(COUNT);
  std::vector<PoseEdge> edges;
  for (int i = 0; i < COUNT; ++i)
    for (const int step : { 1, 3 })
      edges.push_back(edgeOf(i, (i + step) % COUNT, truth[i].inverse() * truth[(i + step) % COUNT]));
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 0.03);
  constexpr int FIXED_POSE = 3;
  std::vector<Eigen::Isometry3d> poses = truth;
  for (int i = 0; i < COUNT; ++i)
    if (i != FIXED_POSE)
    {
      geometry::Vector6d motion;
      for (int axis = 0; axis < 6; ++axis)
        motion[axis] = normal(random);
      poses[i] = poses[i] * geometry::isometryFromVector(motion);
    }
  relaxPoseGraph(edges, FIXED_POSE, &poses);
  EXPECT_EQ(poses[FIXED_POSE].matrix(), truth[FIXED_POSE].matrix());
  for (int i = 0; i < COUNT; ++i)
    EXPECT_TRANSFORM_NEAR(poses[i], truth[i], 1e-6, 1e-6);
}

TEST(RelaxPoseGraph, SpreadsTheErrorOfALoopEvenly)
{
  // Five cameras in one place, whose edges say that each is 0 from the last, and one that they end up 10 cm off.
  constexpr int COUNT = 5;
  std::vector<PoseEdge> edges;
  for (int i = 0; i + 1 < COUNT; ++i)
    edges.push_back(edgeOf(i, i + 1, Eigen::Isometry3d::Identity()));
  edges.push_back(edgeOf(0, COUNT - 1, translated(0.1)));
  std::vector<Eigen::Isometry3d> poses(COUNT, Eigen::Isometry3d::Identity());
  relaxPoseGraph(edges, 0, &poses);
  for (int i = 0; i < COUNT; ++i)
    EXPECT_TRANSFORM_NEAR(poses[i], translated(0.02 * i), AT_THE_MINIMUM, AT_THE_MINIMUM);
  for (const PoseEdge& edge : edges)
    EXPECT_NEAR(edgeError_m(edge, poses), 0.02, AT_THE_MINIMUM);
}

TEST(RelaxPoseGraph, WeighsEdgesByTheirSigmas)
{
  // Weights 1 / 0.002^2 and 1 / 0.004^2: four parts of five against one.
  const std::vector<PoseEdge> edges = { edgeOf(0, 1, translated(0, 0.2), 0.002),
                                        edgeOf(1, 0, translated(0, -0.25), 0.004) };
  for (const int fixed : { 0, 1 })
  {
    std::vector<Eigen::Isometry3d> poses(2, Eigen::Isometry3d::Identity());
    relaxPoseGraph(edges, fixed, &poses);
    EXPECT_TRANSFORM_NEAR(poses[0].inverse() * poses[1], translated(0, 0.21), AT_THE_MINIMUM, AT_THE_MINIMUM);
    EXPECT_EQ(poses[fixed].matrix(), Eigen::Matrix4d::Identity());
  }
}

TEST(RelaxPoseGraph, LeavesWhatNoEdgeReaches)
{
  std::vector<Eigen::Isometry3d> poses(4, translated(1));
  const std::vector<Eigen::Isometry3d> given = poses;
  relaxPoseGraph({}, 0, &poses);
  relaxPoseGraph({ edgeOf(1, 2, translated(0.1)) }, 0, &poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(poses[i].matrix(), given[i].matrix()) << "the fixed one has no edge";
  relaxPoseGraph({ edgeOf(0, 2, translated(0.1)) }, 0, &poses);
  EXPECT_EQ(poses[1].matrix(), given[1].matrix());
  EXPECT_EQ(poses[3].matrix(), given[3].matrix());
  EXPECT_TRANSFORM_NEAR(poses[2], translated(1.1), 1e-6, 1e-6);
}

}  // namespace
}  // namespace object_modelling::bundle_adjustment
