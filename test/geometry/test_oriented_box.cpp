#include "object_modelling/geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "object_modelling/base/status.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::geometry
{
namespace
{
const Eigen::Vector3d BOX_SIZE(0.30, 0.20, 0.07);

/// A grid on the faces of a box of BOX_SIZE, corners included.
std::vector<Eigen::Vector3f> boxSurface(const Eigen::Isometry3d& T_frame_box)
{
  std::vector<Eigen::Vector3f> points;
  constexpr int STEPS = 12;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = -1; side <= 1; side += 2)
      for (int i = 0; i <= STEPS; ++i)
        for (int j = 0; j <= STEPS; ++j)
        {
          Eigen::Vector3d p;
          p[axis] = 0.5 * side;
          p[(axis + 1) % 3] = static_cast<double>(i) / STEPS - 0.5;
          p[(axis + 2) % 3] = static_cast<double>(j) / STEPS - 0.5;
          points.push_back((T_frame_box * p.cwiseProduct(BOX_SIZE).eval()).cast<float>());
        }
  return points;
}

Eigen::Isometry3d tilted()
{
  Vector6d vector;
  vector << 0.4, -0.3, 1.2, 0.9, -0.5, 0.3;
  return isometryFromVector(vector);
}

void expectRightHanded(const OrientedBox& box)
{
  EXPECT_TRUE((box.T_frame_box.linear() * box.T_frame_box.linear().transpose()).isIdentity(1e-9));
  EXPECT_NEAR(box.T_frame_box.linear().determinant(), 1, 1e-9);
}

TEST(OrientedBox, ContainsIsClosed)
{
  OrientedBox box;
  box.T_frame_box = tilted();
  box.size_m = BOX_SIZE;
  EXPECT_TRUE(box.contains(tilted().translation()));
  EXPECT_TRUE(box.contains(tilted() * Eigen::Vector3d(0.1499, -0.0999, 0.0349)));
  EXPECT_FALSE(box.contains(tilted() * Eigen::Vector3d(0.1501, 0, 0)));
  EXPECT_FALSE(box.contains(tilted() * Eigen::Vector3d(0, 0, -0.0351)));
}

TEST(BoxAlong, FindsTheFootprintWhateverItsYaw)
{
  for (const double yaw : { 0.0, 0.3, 0.7853981633974483, 1.2, 2.9 })
  {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translate(Eigen::Vector3d(3, -2, 0.5)).rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    const OrientedBox box = boxAlong(Eigen::Vector3d::UnitZ(), boxSurface(T));
    expectRightHanded(box);
    EXPECT_TRUE(box.size_m.isApprox(BOX_SIZE, 1e-4)) << box.size_m.transpose();
    EXPECT_TRUE(box.T_frame_box.translation().isApprox(T.translation(), 1e-5));
    EXPECT_NEAR(std::abs(box.T_frame_box.linear().col(0).dot(T.linear().col(0))), 1, 1e-5) << yaw;
    EXPECT_TRUE(box.T_frame_box.linear().col(2).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  }
}

TEST(BoxAlong, TiltedUpOfAnyLength)
{
  const OrientedBox box = boxAlong(5 * tilted().linear().col(2), boxSurface(tilted()));
  expectRightHanded(box);
  EXPECT_TRUE(box.size_m.isApprox(BOX_SIZE, 1e-4)) << box.size_m.transpose();
}

TEST(BoxAlong, TrimIgnoresStrayPoints)
{
  std::vector<Eigen::Vector3f> points = boxSurface(tilted());
  points.push_back((tilted() * Eigen::Vector3d(0.5, 0.4, 0.3)).cast<float>());
  points.push_back((tilted() * Eigen::Vector3d(-0.5, 0.1, -0.3)).cast<float>());
  const Eigen::Vector3d up = tilted().linear().col(2);
  EXPECT_GT(boxAlong(up, points).size_m.x(), 0.9);
  const OrientedBox trimmed = boxAlong(up, points, 0.005);
  EXPECT_LT((trimmed.size_m - BOX_SIZE).cwiseAbs().maxCoeff(), 1e-3) << trimmed.size_m.transpose();
  expectRightHanded(trimmed);
}

TEST(BoxAlong, DegenerateCloudsGiveFlatBoxes)
{
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const OrientedBox point = boxAlong(up, { { 1, 2, 3 } });
  EXPECT_EQ(point.size_m, Eigen::Vector3d::Zero());
  EXPECT_TRUE(point.T_frame_box.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  const OrientedBox line = boxAlong(up, { { 0, 0, 0 }, { 1, 1, 0 }, { 2, 2, 0 } });
  EXPECT_NEAR(line.size_m.x(), 2 * std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(line.size_m.y(), 0, 1e-5);
  expectRightHanded(line);
}

TEST(BoxAlong, RefusesNoPointsAndBadTrim)
{
  EXPECT_THROW(boxAlong(Eigen::Vector3d::UnitZ(), {}), base::Error);
  EXPECT_THROW(smallestBox({}), base::Error);
  EXPECT_THROW(boxAlong(Eigen::Vector3d::UnitZ(), { { 1, 2, 3 } }, 0.5), base::Error);
  EXPECT_THROW(smallestBox({ { 1, 2, 3 } }, -0.1), base::Error);
}

TEST(SmallestBox, RecoversATiltedBox)
{
  const OrientedBox box = smallestBox(boxSurface(tilted()));
  expectRightHanded(box);
  Eigen::Vector3d size = box.size_m;
  std::sort(size.data(), size.data() + 3, std::greater<double>());
  EXPECT_TRUE(size.isApprox(BOX_SIZE, 1e-3)) << size.transpose();
  EXPECT_TRUE(box.T_frame_box.translation().isApprox(tilted().translation(), 1e-4));
}

TEST(SmallestBox, TrimIgnoresStrayPoints)
{
  std::vector<Eigen::Vector3f> points = boxSurface(tilted());
  points.push_back((tilted() * Eigen::Vector3d(0.5, 0.4, 0.3)).cast<float>());
  const OrientedBox box = smallestBox(points, 0.005);
  EXPECT_LT(std::abs(box.size_m.prod() - BOX_SIZE.prod()), 0.05 * BOX_SIZE.prod()) << box.size_m.transpose();
}

TEST(SmallestBox, DegenerateClouds)
{
  EXPECT_EQ(smallestBox({ { 1, 2, 3 } }).size_m, Eigen::Vector3d::Zero());
  std::vector<Eigen::Vector3f> flat;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 5; ++j)
      flat.push_back((tilted() * Eigen::Vector3d(0.1 * i, 0.1 * j, 0)).cast<float>());
  const OrientedBox box = smallestBox(flat);
  EXPECT_NEAR(box.size_m.x(), 0.9, 1e-4);
  EXPECT_NEAR(box.size_m.y(), 0.4, 1e-4);
  EXPECT_NEAR(box.size_m.z(), 0, 1e-5);
  EXPECT_NO_THROW(smallestBox(std::vector<Eigen::Vector3f>(20, Eigen::Vector3f(1, 1, 1))));
}

}  // namespace
}  // namespace object_modelling::geometry
