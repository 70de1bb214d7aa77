#include "object_modelling/geometry/plane.h"

#include <gtest/gtest.h>

#include <limits>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::geometry
{
namespace
{
TEST(Plane, SignedDistance)
{
  const Plane table{ Eigen::Vector3d::UnitZ(), -0.7 };  // z = 0.7
  EXPECT_DOUBLE_EQ(table.signedDistance_m({ 5, 3, 1.0 }), 0.3);
  EXPECT_DOUBLE_EQ(table.signedDistance_m({ 5, 3, 0.5 }), -0.2);
}

TEST(Plane, TransformedKeepsDistances)
{
  const Plane plane_b{ Eigen::Vector3d(1, 2, -2) / 3, 0.4 };
  Vector6d motion;
  motion << 0.3, -0.1, 0.8, 0.5, -0.7, 0.2;
  const Eigen::Isometry3d T_a_b = isometryFromVector(motion);
  const Plane plane_a = transformed(T_a_b, plane_b);
  const Eigen::Vector3d p_b(0.7, 0.3, -1.1);
  EXPECT_NEAR(plane_a.signedDistance_m(T_a_b * p_b), plane_b.signedDistance_m(p_b), 1e-14);
  const Plane back = transformed(T_a_b.inverse(), plane_a);
  EXPECT_TRUE(back.normal.isApprox(plane_b.normal, 1e-14));
  EXPECT_NEAR(back.offset_m, plane_b.offset_m, 1e-14);
}

TEST(FitPlane, KnownPlaneFacesTheViewpoint)
{
  const std::vector<Eigen::Vector3d> points = { { 0, 0, 2 }, { 1, 0, 2 }, { 0, 1, 2 }, { 1, 1, 2 }, { 3, -2, 2 } };
  Plane plane;
  ASSERT_TRUE(fitPlane(points, Eigen::Vector3d::Zero(), &plane));
  EXPECT_TRUE(plane.normal.isApprox(-Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_NEAR(plane.offset_m, 2, 1e-12);
  ASSERT_TRUE(fitPlane(points, { 0, 0, 5 }, &plane));
  EXPECT_TRUE(plane.normal.isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST(FitPlane, ExactlyThreePointsFarAway)
{
  const Eigen::Vector3d offset(100, 200, 300);
  const std::vector<Eigen::Vector3d> points = { offset + Eigen::Vector3d(0.1, 0, 0),
                                                offset + Eigen::Vector3d(0, 0.1, 0),
                                                offset + Eigen::Vector3d(0, 0, 0.1) };
  Plane plane;
  ASSERT_TRUE(fitPlane(points, Eigen::Vector3d::Zero(), &plane));
  EXPECT_TRUE(plane.normal.isApprox(-Eigen::Vector3d::Ones().normalized(), 1e-9));
}

TEST(FitPlane, RefusesDegenerateInput)
{
  Plane plane;
  const Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  EXPECT_FALSE(fitPlane({}, eye, &plane));
  EXPECT_FALSE(fitPlane({ { 0, 0, 1 }, { 1, 0, 1 } }, eye, &plane));
  EXPECT_FALSE(fitPlane({ { 0, 0, 1 }, { 1, 1, 1 }, { 2, 2, 1 }, { 3, 3, 1 } }, eye, &plane));
  EXPECT_FALSE(fitPlane({ { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } }, eye, &plane));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fitPlane({ { 0, 0, 1 }, { 1, 0, nan }, { 0, 1, 1 } }, eye, &plane));
}

}  // namespace
}  // namespace object_modelling::geometry
