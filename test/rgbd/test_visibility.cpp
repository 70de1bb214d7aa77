#include "object_modelling/rgbd/visibility.h"

#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace object_modelling::rgbd
{
namespace
{
geometry::PinholeCamera smallCamera()
{
  geometry::PinholeCamera camera;
  camera.width = 8;
  camera.height = 6;
  camera.fx = camera.fy = 10;
  camera.cx = 3.5;
  camera.cy = 2.5;
  return camera;
}

/// A wall 2 m away, known in all pixels but (2, 1).
cv::Mat wall_m()
{
  cv::Mat depth_m(6, 8, CV_32FC1, cv::Scalar(2));
  depth_m.at<float>(1, 2) = std::numeric_limits<float>::quiet_NaN();
  return depth_m;
}

Visibility seenOf(const Eigen::Vector3d& p_camera)
{
  const Visibility seen = visibilityOf(geometry::projectionOf(smallCamera(), p_camera), wall_m(), 0.25);
  const Eigen::Vector3f in_float = p_camera.cast<float>();
  EXPECT_EQ(visibilityOf(geometry::projectionOf(smallCamera(), in_float), wall_m(), 0.25F), seen);
  return seen;
}
}  // namespace

TEST(Visibility, ComparesAPointWithWhatWasMeasured)
{
  EXPECT_EQ(visibilityOf(1.0, 1.2, 0.1), Visibility::IN_FRONT);
  EXPECT_EQ(visibilityOf(1.0, 0.8, 0.1), Visibility::BEHIND);
  EXPECT_EQ(visibilityOf(1.0, 1.05, 0.1), Visibility::ON);
  EXPECT_EQ(visibilityOf(1.0, 0.95, 0.1), Visibility::ON);
}

TEST(Visibility, TheToleranceItselfIsOn)
{
  EXPECT_EQ(visibilityOf(1.0F, 1.25F, 0.25F), Visibility::ON);
  EXPECT_EQ(visibilityOf(1.0F, 0.75F, 0.25F), Visibility::ON);
}

TEST(Visibility, IsUnknownWhereNothingWasMeasured)
{
  EXPECT_EQ(visibilityOf(1.0F, std::numeric_limits<float>::quiet_NaN(), 0.1F), Visibility::UNKNOWN);
  EXPECT_EQ(visibilityOf(1.0F, std::numeric_limits<float>::infinity(), 0.1F), Visibility::UNKNOWN);
  EXPECT_EQ(visibilityOf(1.0F, 0.0F, 0.1F), Visibility::UNKNOWN);
}

TEST(Visibility, LooksUpWhereThePointFalls)
{
  EXPECT_EQ(seenOf({ 0, 0, 1.5 }), Visibility::IN_FRONT);
  EXPECT_EQ(seenOf({ 0, 0, 2 }), Visibility::ON);
  EXPECT_EQ(seenOf({ 0, 0, 2.5 }), Visibility::BEHIND);
  EXPECT_EQ(seenOf(smallCamera().unproject(2.3, 0.7, 2)), Visibility::UNKNOWN);
  EXPECT_EQ(seenOf(smallCamera().unproject(1.7, 2.3, 2)), Visibility::ON);
}

TEST(Visibility, IsOutsideWhereThePointFallsIntoNoPixel)
{
  EXPECT_EQ(seenOf(smallCamera().unproject(7.4, 5.4, 2)), Visibility::ON);
  EXPECT_EQ(seenOf(smallCamera().unproject(7.6, 3, 2)), Visibility::OUTSIDE);
  EXPECT_EQ(seenOf(smallCamera().unproject(3, -0.6, 2)), Visibility::OUTSIDE);
  EXPECT_EQ(seenOf({ 0, 0, -2 }), Visibility::OUTSIDE);
  EXPECT_EQ(seenOf({ 0, 0, std::numeric_limits<double>::quiet_NaN() }), Visibility::OUTSIDE);
}

TEST(Visibility, OfAPointBetweenTwoViewsAgrees)
{
  // b faces a from the other side of a thin wall that both see 2 m away: what is on it for one is on it for the other,
  // and what is in front for one is behind for the other.
  const Eigen::Isometry3d T_b_a = Eigen::Translation3d(0, 0, 4) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY());
  for (const double z_m : { 1.5, 2.0, 2.5 })
  {
    const Eigen::Vector3d p_a(0.05, 0.05, z_m);
    const Visibility by_a = seenOf(p_a), by_b = seenOf(T_b_a * p_a), back = seenOf(T_b_a.inverse() * (T_b_a * p_a));
    EXPECT_EQ(back, by_a);
    EXPECT_EQ(by_a == Visibility::ON, by_b == Visibility::ON);
    EXPECT_EQ(by_a == Visibility::IN_FRONT, by_b == Visibility::BEHIND);
  }
}

TEST(Visibility, ComparesInThePrecisionOfTheTolerance)
{
  const Eigen::Vector3f p(0, 0, 1.75F);
  const geometry::Projection<float> at = geometry::projectionOf(smallCamera(), p);
  EXPECT_EQ(visibilityOf(at, wall_m(), 0.25), Visibility::ON);
  EXPECT_EQ(visibilityOf(at, wall_m(), 0.25 - 1e-12), Visibility::IN_FRONT);
}

}  // namespace object_modelling::rgbd
