#include "plane_moments.h"

#include <gtest/gtest.h>

namespace object_modelling::segmentation
{
namespace
{
PlaneMoments grid(const Eigen::Isometry3d& T, double height_m = 0)
{
  PlaneMoments moments;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      moments.add(T * Eigen::Vector3d(0.01 * i, 0.02 * j, (i + j) % 2 == 0 ? height_m : -height_m), 4);
  return moments;
}

Eigen::Isometry3d somewhere()
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  T.pretranslate(Eigen::Vector3d(0.3, -0.2, 1.4));
  return T;
}

}  // namespace

TEST(PlaneMoments, FitsAPlaneTowardsTheViewpoint)
{
  const Eigen::Isometry3d T = somewhere();
  for (const double side : { 1.0, -1.0 })
  {
    geometry::Plane plane;
    ASSERT_TRUE(grid(T).fit(T * Eigen::Vector3d(0, 0, side), &plane));
    EXPECT_LT((plane.normal - side * (T.linear() * Eigen::Vector3d::UnitZ())).norm(), 1e-9);
    EXPECT_NEAR(plane.signedDistance_m(T.translation()), 0, 1e-9);
  }
}

TEST(PlaneMoments, MeasuresResidualsPerPoint)
{
  const Eigen::Isometry3d T = somewhere();
  const PlaneMoments moments = grid(T, 0.003);
  geometry::Plane plane;
  ASSERT_TRUE(moments.fit(Eigen::Vector3d::Zero(), &plane));
  EXPECT_NEAR(moments.meanSquare(plane), 4 * 0.003 * 0.003, 1e-7);
}

TEST(PlaneMoments, MoveWithTheirPoints)
{
  const Eigen::Isometry3d T = somewhere();
  const PlaneMoments moved = grid(Eigen::Isometry3d::Identity(), 0.002).transformed(T);
  const PlaneMoments direct = grid(T, 0.002);
  EXPECT_EQ(moved.count, direct.count);
  EXPECT_LT((moved.sum - direct.sum).norm(), 1e-9);
  EXPECT_LT((moved.sum_of_squares - direct.sum_of_squares).norm(), 1e-9);
}

TEST(PlaneMoments, RefuseWhatHasNoPlane)
{
  geometry::Plane plane;
  PlaneMoments moments;
  EXPECT_FALSE(moments.fit(Eigen::Vector3d::Zero(), &plane));
  for (int i = 0; i < 10; ++i)
    moments.add(Eigen::Vector3d(0.1 * i, 0, 1), 1);
  EXPECT_FALSE(moments.fit(Eigen::Vector3d::Zero(), &plane)) << "collinear points";
}

}  // namespace object_modelling::segmentation
