#include "object_modelling/geometry/transform.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/transform_matchers.h"

namespace object_modelling::geometry
{
namespace
{
Eigen::Isometry3d someTransform()
{
  return isometryFrom(Eigen::Quaterniond(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized())),
                      { 0.3, -0.2, 1.5 });
}

/// Columns that are not in one plane.
Eigen::Matrix3Xd somePoints()
{
  Eigen::Matrix3Xd points(3, 5);
  points << 0, 1, 0, 0, 0.3,  //
      0, 0, 2, 0, -0.4,       //
      0, 0, 0, 3, 0.5;
  return points;
}

TEST(Transform, VectorKnownAnswer)
{
  Vector6d vector;
  vector << 1, 2, 3, 0, 0, M_PI / 2;
  const Eigen::Isometry3d T = isometryFromVector(vector);
  EXPECT_TRUE((T * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
}

TEST(Transform, VectorRoundTrip)
{
  for (const double angle : { 0.0, 1e-12, 1e-9, 1e-6, 0.1, 1.0, 3.0, M_PI - 1e-6 })
  {
    Vector6d vector;
    vector << 0.1, -0.2, 0.3, angle * Eigen::Vector3d(2, -1, 2) / 3;
    EXPECT_LT((vectorFromIsometry(isometryFromVector(vector)) - vector).norm(), 1e-9) << angle;
  }
}

TEST(Transform, LargeRotationVectorsWrapRound)
{
  Vector6d vector = Vector6d::Zero();
  vector.tail<3>() = (2 * M_PI + 0.25) * Eigen::Vector3d::UnitY();
  EXPECT_NEAR(rotationAngle_rad(isometryFromVector(vector)), 0.25, 1e-9);
}

TEST(Transform, RotationAngle)
{
  EXPECT_EQ(rotationAngle_rad(Eigen::Isometry3d::Identity()), 0);
  EXPECT_NEAR(rotationAngle_rad(someTransform()), 1.1, 1e-12);
  EXPECT_NEAR(rotationAngle_rad(someTransform().inverse()), 1.1, 1e-12);
  Vector6d half_turn = Vector6d::Zero();
  half_turn[4] = M_PI;
  EXPECT_NEAR(rotationAngle_rad(isometryFromVector(half_turn)), M_PI, 1e-9);
}

TEST(Transform, IsometryFromNormalizesItsQuaternion)
{
  const Eigen::Isometry3d T = isometryFrom(Eigen::Quaterniond(2, 0, 0, 0), { 1, 2, 3 });
  EXPECT_TRUE(T.linear().isIdentity(1e-15));
  EXPECT_EQ(T.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(Transform, NormalizedRemovesDrift)
{
  Eigen::Isometry3d T = someTransform();
  T.linear() *= 1.001;
  T.linear()(0, 1) += 1e-4;
  const Eigen::Isometry3d fixed = normalized(T);
  EXPECT_TRUE((fixed.linear() * fixed.linear().transpose()).isIdentity(1e-12));
  EXPECT_NEAR(fixed.linear().determinant(), 1, 1e-12);
  EXPECT_TRANSFORM_NEAR(fixed, someTransform(), 1e-12, 1e-3);
}

TEST(Transform, AdjointTakesSmallMotionsToAnotherFrame)
{
  Vector6d pose;
  pose << 0.4, -0.3, 0.9, 0.5, -1.1, 0.7;
  const Eigen::Isometry3d T_a_b = isometryFromVector(pose);
  for (int i = 0; i < 6; ++i)
  {
    const Vector6d motion_b = 1e-6 * Vector6d::Unit(i);
    const Vector6d motion_a = vectorFromIsometry(T_a_b * isometryFromVector(motion_b) * T_a_b.inverse());
    EXPECT_LT((motion_a - adjoint(T_a_b) * motion_b).norm(), 1e-10) << i;
  }
  EXPECT_TRUE((adjoint(T_a_b) * adjoint(T_a_b.inverse())).isIdentity(1e-12));
}

TEST(RigidTransformFromPoints, RecoversBothDirections)
{
  const Eigen::Isometry3d T_a_b = someTransform();
  const Eigen::Matrix3Xd p_b = somePoints();
  const Eigen::Matrix3Xd p_a = (T_a_b.linear() * p_b).colwise() + T_a_b.translation();
  Eigen::Isometry3d T;
  ASSERT_TRUE(rigidTransformFromPoints(p_a, p_b, &T));
  EXPECT_TRANSFORM_NEAR(T, T_a_b, 1e-12, 1e-7);
  ASSERT_TRUE(rigidTransformFromPoints(p_b, p_a, &T));
  EXPECT_TRANSFORM_NEAR(T, T_a_b.inverse(), 1e-12, 1e-7);
}

TEST(RigidTransformFromPoints, CoplanarPointsAndFarOrigin)
{
  const Eigen::Isometry3d T_a_b = someTransform();
  const Eigen::Matrix3Xd p_b = somePoints().leftCols(3).colwise() + Eigen::Vector3d(100, -50, 20);
  const Eigen::Matrix3Xd p_a = (T_a_b.linear() * p_b).colwise() + T_a_b.translation();
  Eigen::Isometry3d T;
  ASSERT_TRUE(rigidTransformFromPoints(p_a, p_b, &T));
  EXPECT_TRANSFORM_NEAR(T, T_a_b, 1e-9, 1e-7);
}

TEST(RigidTransformFromPoints, NeverReflects)
{
  const Eigen::Matrix3Xd p_b = somePoints();
  Eigen::Matrix3Xd mirrored = p_b;
  mirrored.row(0) *= -1;
  Eigen::Isometry3d T;
  ASSERT_TRUE(rigidTransformFromPoints(mirrored, p_b, &T));
  EXPECT_NEAR(T.linear().determinant(), 1, 1e-9);
}

TEST(RigidTransformFromPoints, RefusesDegenerateInput)
{
  Eigen::Isometry3d T = someTransform();
  const Eigen::Matrix3Xd points = somePoints();
  EXPECT_FALSE(rigidTransformFromPoints(points.leftCols(2), points.leftCols(2), &T));
  EXPECT_FALSE(rigidTransformFromPoints(points.leftCols(3), points, &T));
  Eigen::Matrix3Xd line(3, 4);
  line << 0, 1, 2, 3, 0, 2, 4, 6, 0, 3, 6, 9;
  EXPECT_FALSE(rigidTransformFromPoints(line, line, &T));
  EXPECT_FALSE(rigidTransformFromPoints(Eigen::Matrix3Xd::Ones(3, 6), points.leftCols(5), &T));
  EXPECT_FALSE(rigidTransformFromPoints(Eigen::Matrix3Xd::Ones(3, 5), Eigen::Matrix3Xd::Ones(3, 5), &T));
  Eigen::Matrix3Xd broken = points;
  broken(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rigidTransformFromPoints(broken, points, &T));
  EXPECT_TRANSFORM_NEAR(T, someTransform(), 0, 1e-7);  // untouched
}

TEST(Transform, RotationBetweenTakesOneDirectionToTheOther)
{
  const Eigen::Vector3d from(0.3, -1, 2), to(-1, 0.2, 0.1);
  const Eigen::Matrix3d R = rotationBetween(from, to);
  EXPECT_TRUE((R * from.normalized()).isApprox(to.normalized(), 1e-12));
  EXPECT_NEAR(R.determinant(), 1, 1e-12);
  // The smallest one: about an axis that is perpendicular to both.
  EXPECT_TRUE((R * from.cross(to)).isApprox(from.cross(to), 1e-12));
  EXPECT_TRUE(rotationBetween(Eigen::Vector3f(from.cast<float>()), Eigen::Vector3f(to.cast<float>()))
                  .isApprox(R.cast<float>(), 1e-5F));
}

TEST(Transform, RotationBetweenEqualAndOppositeDirections)
{
  const Eigen::Vector3d direction(1, 2, -0.5);
  EXPECT_TRUE(rotationBetween(direction, 3 * direction).isApprox(Eigen::Matrix3d::Identity(), 1e-9));
  const Eigen::Matrix3d R = rotationBetween(direction, -direction);
  EXPECT_TRUE((R * direction).isApprox(-direction, 1e-9));
  EXPECT_NEAR(R.determinant(), 1, 1e-9);
}

}  // namespace
}  // namespace object_modelling::geometry
