#include <gtest/gtest.h>

#include <random>

#include "model_frame.h"
#include "object_modelling/base/status.h"
#include "support/transform_matchers.h"

namespace object_modelling::pipeline
{
namespace
{
/// Surface points of a box about the origin, corners included, moved by T.
std::vector<Eigen::Vector3f> boxPoints(const Eigen::Vector3d& size_m, const Eigen::Isometry3d& T, int steps = 8)
{
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      for (int k = 0; k <= steps; ++k)
        if (i % steps == 0 || j % steps == 0 || k % steps == 0)
          points.push_back(
              (T * (Eigen::Vector3d(i, j, k) / steps - Eigen::Vector3d::Constant(0.5)).cwiseProduct(size_m).eval())
                  .cast<float>());
  return points;
}

/// Camera frame: x right, y down, z ahead; a support seen from 30 degrees above.
Eigen::Isometry3d cameraView()
{
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  T_camera_world.linear() = Eigen::AngleAxisd(M_PI / 2 + M_PI / 6, Eigen::Vector3d::UnitX()).toRotationMatrix();
  T_camera_world.translation() = Eigen::Vector3d(0.05, 0.1, 0.7);
  return T_camera_world;
}

/// A box of 0.2 x 0.1 x 0.3 m, turned by 0.4 rad on the table, whose lowest points are `gap_m` above it.
struct StandingBox
{
  explicit StandingBox(double gap_m, const Eigen::Vector3d& size_m = { 0.2, 0.1, 0.3 })
  {
    Eigen::Isometry3d T_world_box(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
    T_world_box.translation() = Eigen::Vector3d(0.1, -0.2, gap_m + size_m.z() / 2);
    T_camera_box = cameraView() * T_world_box;
    points = boxPoints(size_m, T_camera_box);
    plane = geometry::transformed(cameraView(), geometry::Plane{ Eigen::Vector3d::UnitZ(), 0 });
  }
  double bottom_m(const geometry::OrientedBox& box) const
  {
    return plane.signedDistance_m(box.T_frame_box * Eigen::Vector3d(0, 0, -box.size_m.z() / 2));
  }

  Eigen::Isometry3d T_camera_box;
  std::vector<Eigen::Vector3f> points;
  geometry::Plane plane;
};

void expectRightHanded(const Eigen::Isometry3d& T)
{
  EXPECT_NEAR(T.linear().determinant(), 1, 1e-6);
  EXPECT_LT((T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-6);
}
}  // namespace

TEST(ObjectBox, StandsOnItsSupport)
{
  const StandingBox standing(0);
  const geometry::OrientedBox box = objectBox(standing.points, standing.plane);
  EXPECT_LT((box.size_m - Eigen::Vector3d(0.2, 0.1, 0.3)).norm(), 1e-5);
  EXPECT_LT((box.T_frame_box.translation() - standing.T_camera_box.translation()).norm(), 1e-5);
  EXPECT_GT(box.T_frame_box.linear().col(2).dot(standing.plane.normal), 1 - 1e-6);
  EXPECT_GT(std::abs(box.T_frame_box.linear().col(0).dot(standing.T_camera_box.linear().col(0))), 1 - 1e-6);
  expectRightHanded(box.T_frame_box);
}

TEST(ObjectBox, ReachesDownToTheSupportThatSegmentationKeepsOff)
{
  const StandingBox standing(0.008);
  const geometry::OrientedBox box = objectBox(standing.points, standing.plane);
  EXPECT_NEAR(box.size_m.z(), 0.308, 1e-5);
  EXPECT_NEAR(standing.bottom_m(box), 0, 1e-5);
  EXPECT_LT(
      (box.T_frame_box.translation() - (standing.T_camera_box.translation() - 0.004 * standing.plane.normal)).norm(),
      1e-5);
}

TEST(ObjectBox, EndsAtTheSupportWhereNoiseReachesBelow)
{
  const StandingBox standing(-0.003);
  const geometry::OrientedBox box = objectBox(standing.points, standing.plane);
  EXPECT_NEAR(box.size_m.z(), 0.297, 1e-5);
  EXPECT_NEAR(standing.bottom_m(box), 0, 1e-5);
}

TEST(ObjectBox, IgnoresThePlaneThatIsFarFromTheFoot)
{
  for (const double gap_m : { 0.05, -0.05 })
  {
    const StandingBox standing(gap_m);
    const geometry::OrientedBox box = objectBox(standing.points, standing.plane);
    EXPECT_NEAR(box.size_m.z(), 0.3, 1e-5) << gap_m;
    EXPECT_NEAR(standing.bottom_m(box), gap_m, 1e-5) << gap_m;
  }
}

// A sheet of paper whose points the noise has put below the table: a box has no negative height.
TEST(ObjectBox, HasNoNegativeHeight)
{
  const StandingBox sheet(-0.003, { 0.2, 0.1, 0.001 });
  const geometry::OrientedBox box = objectBox(sheet.points, sheet.plane);
  EXPECT_GE(box.size_m.z(), 0);
  EXPECT_NEAR(box.size_m.x(), 0.2, 1e-5);
}

TEST(ObjectBox, TakesTheCamerasUpWithoutASupport)
{
  const StandingBox standing(0);
  const geometry::OrientedBox box = objectBox(standing.points, std::nullopt);
  EXPECT_LT((box.size_m - Eigen::Vector3d(0.2, 0.1, 0.3)).norm(), 1e-4);
  EXPECT_LT((box.T_frame_box.translation() - standing.T_camera_box.translation()).norm(), 1e-4);
  EXPECT_GT(box.T_frame_box.linear().col(2).dot(standing.plane.normal), 1 - 1e-4);
  expectRightHanded(box.T_frame_box);
}

TEST(ObjectBox, RefusesNoPoints)
{
  EXPECT_THROW(objectBox({}, std::nullopt), base::Error);
  EXPECT_THROW(objectBox({}, geometry::Plane()), base::Error);
}

TEST(Diameter, OfKnownShapes)
{
  EXPECT_EQ(diameter_m({}), 0);
  EXPECT_EQ(diameter_m({ { 1, 2, 3 } }), 0);
  EXPECT_FLOAT_EQ(diameter_m({ { 0, 0, 0 }, { 3, 4, 0 } }), 5);
  const Eigen::Isometry3d T(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  EXPECT_NEAR(diameter_m(boxPoints({ 0.2, 0.1, 0.3 }, T)), std::sqrt(0.04 + 0.01 + 0.09), 1e-5);

  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> sphere;
  for (int i = 0; i < 20000; ++i)
    sphere.push_back(0.5f * Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized());
  EXPECT_NEAR(diameter_m(sphere), 1, 1e-3);
}

}  // namespace object_modelling::pipeline
