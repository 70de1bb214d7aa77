#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/rgbd/pose_certainty.h"
#include "pose_uncertainty.h"

namespace object_modelling::tracking
{
namespace
{
Eigen::Isometry3d somePose()
{
  geometry::Vector6d x;
  x << 0.4, -0.2, 0.9, 0.5, -1.1, 0.3;
  return geometry::isometryFromVector(x);
}

geometry::Matrix6d someCovariance()
{
  geometry::Matrix6d J;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      J(i, j) = std::sin(1.7 * i + 0.6 * j * j + 0.3) + (i == j ? 2 : 0);
  return J * J.transpose();
}
}  // namespace

TEST(PoseUncertainty, ChangesFrameThereAndBack)
{
  const geometry::Matrix6d covariance = someCovariance();
  const Eigen::Isometry3d T = somePose();
  EXPECT_TRUE(rgbd::inCameraFrame(inSessionFrame(covariance, T), T).isApprox(covariance, 1e-9));
  EXPECT_TRUE(inSessionFrame(rgbd::inCameraFrame(covariance, T), T).isApprox(covariance, 1e-9));
  EXPECT_FALSE(inSessionFrame(covariance, T).isApprox(covariance, 1e-2));
  EXPECT_TRUE(inSessionFrame(covariance, Eigen::Isometry3d::Identity()).isApprox(covariance, 1e-12));
}

TEST(PoseUncertainty, TurningFarFromTheOriginMovesIt)
{
  // A camera 2 m up the session's z, unsure of its rotation about x alone: seen from the session's origin it swings
  // along y, and both errors are one.
  Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();
  T_session_camera.translation() = Eigen::Vector3d(0, 0, 2);
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance(3, 3) = 0.01 * 0.01;
  geometry::Matrix6d expected = covariance;
  expected(1, 1) = 0.02 * 0.02;
  expected(1, 3) = expected(3, 1) = 0.02 * 0.01;
  EXPECT_TRUE(inSessionFrame(covariance, T_session_camera).isApprox(expected, 1e-12))
      << inSessionFrame(covariance, T_session_camera);
}

TEST(PoseUncertainty, AgreesWithMovingTheTransforms)
{
  // A small motion on the left of T_camera_session as one on the left of its inverse.
  const Eigen::Isometry3d T_session_camera = somePose();
  for (int axis = 0; axis < 6; ++axis)
  {
    const geometry::Vector6d xi = 1e-6 * geometry::Vector6d::Unit(axis);
    const Eigen::Isometry3d T_camera_session = geometry::isometryFromVector(xi) * T_session_camera.inverse();
    const geometry::Vector6d moved =
        geometry::vectorFromIsometry(T_camera_session.inverse() * T_session_camera.inverse());
    const geometry::Matrix6d covariance = inSessionFrame(xi * xi.transpose(), T_session_camera);
    EXPECT_LT((covariance - moved * moved.transpose()).norm(), 1e-4 * covariance.norm()) << axis;
  }
}

TEST(PoseUncertainty, AHandMayDoMoreInMoreTime)
{
  EXPECT_TRUE(handMotionCovariance(0).isZero());
  double last = 0;
  for (const double elapsed_s : { 0.01, 1 / 30.0, 0.1, 0.5, 2.0 })
  {
    const geometry::Matrix6d covariance = handMotionCovariance(elapsed_s);
    EXPECT_GT(covariance.diagonal().minCoeff(), last) << elapsed_s;
    last = covariance.diagonal().maxCoeff() / 100;
    // Half the acceleration times the time squared.
    EXPECT_TRUE(handMotionCovariance(2 * elapsed_s).isApprox(16 * covariance, 1e-9));
  }
  // Between two frames: millimetres and a degree or two.
  const geometry::Matrix6d frame = handMotionCovariance(1 / 30.0);
  EXPECT_GT(std::sqrt(frame(0, 0)), 0.001);
  EXPECT_LT(std::sqrt(frame(0, 0)), 0.02);
  EXPECT_GT(std::sqrt(frame(3, 3)), 0.005);
  EXPECT_LT(std::sqrt(frame(3, 3)), 0.1);
}

TEST(PoseUncertainty, RobotAndSystematicErrors)
{
  const geometry::Matrix6d robot = robotMotionCovariance(0.003, 0.01);
  geometry::Vector6d variances;
  variances << 9e-6, 9e-6, 9e-6, 1e-4, 1e-4, 1e-4;
  EXPECT_TRUE(robot.isApprox(geometry::Matrix6d(variances.asDiagonal()), 1e-12));
  const geometry::Matrix6d near = systematicCovariance(0.5, 0.001);
  const geometry::Matrix6d far = systematicCovariance(1.0, 0.001);
  EXPECT_NEAR(far(0, 0), 4 * near(0, 0), 1e-12);
  EXPECT_EQ(far(5, 5), near(5, 5));
  // Rays that err more do so together; those that seem not to err at all are not to be believed.
  EXPECT_NEAR(systematicCovariance(1.0, 0.002)(5, 5), 4 * far(5, 5), 1e-12);
  EXPECT_GT(systematicCovariance(1.0, 0)(5, 5), 0);
}
}  // namespace object_modelling::tracking
