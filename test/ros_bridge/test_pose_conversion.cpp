#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::ros_bridge
{
namespace
{
Eigen::Isometry3d turnedPose()
{
  return geometry::isometryFrom(Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized())),
                                { 0.4, -0.8, 1.5 });
}

geometry::Matrix6d someCovariance()
{
  geometry::Matrix6d root;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < root.size(); ++i)  // Eigen 3.3 has no reshaped()
    root.data()[i] = 1e-3 * normal(random);
  return root * root.transpose();
}

geometry::Matrix6d matrixOf(const geometry_msgs::PoseWithCovariance& message)
{
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.covariance.data());
}
}  // namespace

// What the message says is the spread of the positions and of the rotations about the target's axes.
TEST(PoseConversion, CovarianceIsThatOfPositionAndFixedAxes)
{
  const Eigen::Isometry3d T = turnedPose();
  const geometry::Matrix6d covariance = someCovariance();
  const geometry::Matrix6d root = covariance.llt().matrixL();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr int DRAWS = 20000;
  geometry::Matrix6d spread = geometry::Matrix6d::Zero();
  for (int draw = 0; draw < DRAWS; ++draw)
  {
    geometry::Vector6d sample;
    for (int i = 0; i < 6; ++i)
      sample[i] = normal(random);
    const Eigen::Isometry3d T_drawn = geometry::isometryFromVector(root * sample) * T;
    const Eigen::AngleAxisd turned(T_drawn.linear() * T.linear().transpose());
    geometry::Vector6d error;
    error << T_drawn.translation() - T.translation(), turned.angle() * turned.axis();
    spread += error * error.transpose() / DRAWS;
  }
  const geometry::Matrix6d told = matrixOf(toMessage(T, covariance));
  EXPECT_LT((told - spread).norm(), 0.03 * spread.norm());
  EXPECT_GT((covariance - spread).norm(), 0.3 * spread.norm()) << "the pose is far enough out to tell them apart";
}

TEST(PoseConversion, CovarianceOfARotationAboutTheTargetsOriginMovesADistantCamera)
{
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance(5, 5) = 1e-4;  // 0.01 rad about z
  const Eigen::Isometry3d T(Eigen::Translation3d(2, 0, 0));
  const geometry_msgs::PoseWithCovariance message = toMessage(T, covariance);
  EXPECT_NEAR(message.covariance[6 * 1 + 1], 4e-4, 1e-12);  // y: 2 m x 0.01 rad
  EXPECT_NEAR(message.covariance[6 * 1 + 5], 2e-4, 1e-12);
  EXPECT_NEAR(message.covariance[0], 0, 1e-12);
  EXPECT_NEAR(message.covariance[6 * 5 + 5], 1e-4, 1e-12);
}

TEST(PoseConversion, CovarianceComesBack)
{
  const geometry::Matrix6d covariance = someCovariance();
  EXPECT_TRUE(covarianceFromMessage(toMessage(turnedPose(), covariance)).isApprox(covariance, 1e-9));
  EXPECT_TRUE(covarianceFromMessage(toMessage(turnedPose(), geometry::Matrix6d::Zero())).isZero(0));
  geometry_msgs::PoseWithCovariance message = toMessage(turnedPose(), covariance);
  message.covariance[3] = std::nan("");
  EXPECT_THROW(covarianceFromMessage(message), base::Error);
}

}  // namespace object_modelling::ros_bridge
