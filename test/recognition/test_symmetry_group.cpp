#include "object_modelling/recognition/symmetry_group.h"

#include <gtest/gtest.h>

#include <cmath>

namespace object_modelling::recognition
{
namespace
{
using object_properties::Symmetry;

Symmetry symmetry(const Eigen::Vector3d& axis, int order, Symmetry::Of of = Symmetry::Of::TEXTURE)
{
  Symmetry result;
  result.of = of;
  result.axis = axis.normalized();
  result.order = order;
  return result;
}

Eigen::Matrix3d turn(double angle_rad, const Eigen::Vector3d& axis)
{
  return Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
}

const Eigen::Matrix3d R = turn(0.7, { 1, 2, 3 });
const Eigen::Vector3d X = Eigen::Vector3d::UnitX(), Y = Eigen::Vector3d::UnitY(), Z = Eigen::Vector3d::UnitZ();
constexpr double ERROR_RAD = 1e-6;

double angleOfTurn(const SymmetryGroup& group, const Eigen::Matrix3d& turned)
{
  return group.angleBetween(R, R * turned);
}

TEST(SymmetryGroup, WithoutSymmetriesEveryTurnCounts)
{
  EXPECT_NEAR(angleOfTurn(SymmetryGroup(), turn(0.3, X)), 0.3, ERROR_RAD);
  EXPECT_NEAR(angleOfTurn(SymmetryGroup(), turn(M_PI, Z)), M_PI, ERROR_RAD);
  const SymmetryGroup of_texture({ symmetry(Z, 2, Symmetry::Of::SHAPE) }, Symmetry::Of::TEXTURE);
  EXPECT_NEAR(angleOfTurn(of_texture, turn(M_PI, Z)), M_PI, ERROR_RAD) << "only the shape stays the same";
}

TEST(SymmetryGroup, TurnsOfABoxFollowFromTwoAxes)
{
  const SymmetryGroup group({ symmetry(X, 2), symmetry(Y, 2) }, Symmetry::Of::TEXTURE);
  for (const Eigen::Vector3d& axis : { X, Y, Z })
    EXPECT_NEAR(angleOfTurn(group, turn(M_PI, axis)), 0, ERROR_RAD);
  EXPECT_NEAR(angleOfTurn(group, turn(M_PI_2, Z)), M_PI_2, ERROR_RAD);
}

TEST(SymmetryGroup, TurnsOfACubeAreClosed)
{
  const SymmetryGroup group({ symmetry(Z, 4), symmetry(X, 4) }, Symmetry::Of::TEXTURE);
  EXPECT_NEAR(angleOfTurn(group, turn(2 * M_PI / 3, { 1, 1, 1 })), 0, ERROR_RAD);
  EXPECT_NEAR(angleOfTurn(group, turn(M_PI_4, Z)), M_PI_4, ERROR_RAD);
}

TEST(SymmetryGroup, ACanMayTurnAboutItsAxisAndOver)
{
  const SymmetryGroup upright({ symmetry(Z, 0) }, Symmetry::Of::TEXTURE);
  EXPECT_NEAR(angleOfTurn(upright, turn(1.234, Z)), 0, ERROR_RAD);
  EXPECT_NEAR(angleOfTurn(upright, turn(0.2, X)), 0.2, ERROR_RAD);
  EXPECT_NEAR(angleOfTurn(upright, turn(M_PI, X)), M_PI, ERROR_RAD);
  const SymmetryGroup either_way({ symmetry(Z, 0), symmetry(X, 2) }, Symmetry::Of::TEXTURE);
  EXPECT_NEAR(angleOfTurn(either_way, turn(1.234, Z) * turn(M_PI, X)), 0, ERROR_RAD);
}

TEST(SymmetryGroup, ABallLooksTheSameFromEverywhere)
{
  const SymmetryGroup group({ symmetry(Z, 0), symmetry({ 1, 0, 1 }, 0) }, Symmetry::Of::TEXTURE);
  for (const double angle_rad : { 0.2, 1.7, M_PI })
    EXPECT_EQ(angleOfTurn(group, turn(angle_rad, { 1, -2, 0.5 })), 0);
  const SymmetryGroup one_axis_twice({ symmetry(Z, 0), symmetry(-Z, 0) }, Symmetry::Of::TEXTURE);
  EXPECT_NEAR(angleOfTurn(one_axis_twice, turn(0.2, X)), 0.2, ERROR_RAD);
}

}  // namespace
}  // namespace object_modelling::recognition
