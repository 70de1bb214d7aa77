#include "object_modelling/geometry/pinhole_camera.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/violations.h"

namespace object_modelling::geometry
{
namespace
{
PinholeCamera someCamera()
{
  PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 525;
  camera.fy = 520;
  camera.cx = 319.5;
  camera.cy = 240;
  return camera;
}

TEST(PinholeCamera, ProjectKnownAnswerAndInverse)
{
  const PinholeCamera camera = someCamera();
  EXPECT_EQ(camera.project({ 0, 0, 2 }), Eigen::Vector2d(319.5, 240));
  EXPECT_EQ(camera.project({ 1, -0.5, 2 }), Eigen::Vector2d(319.5 + 262.5, 240 - 130));
  const Eigen::Vector3d p = camera.unproject(12.25, 400.5, 1.7);
  EXPECT_DOUBLE_EQ(p.z(), 1.7);
  EXPECT_TRUE(camera.project(p).isApprox(Eigen::Vector2d(12.25, 400.5), 1e-12));
}

TEST(PinholeCamera, ContainsCountsPixelCenters)
{
  const PinholeCamera camera = someCamera();
  EXPECT_TRUE(camera.contains({ 0, 0 }));
  EXPECT_TRUE(camera.contains({ 639, 479 }));
  EXPECT_FALSE(camera.contains({ 639.01, 479 }));
  EXPECT_FALSE(camera.contains({ -0.01, 5 }));
  EXPECT_FALSE(camera.contains({ 3, 100 }, 4));
  EXPECT_FALSE(camera.contains({ std::numeric_limits<double>::quiet_NaN(), 5 }));
}

TEST(PinholeCamera, ScaledSeesTheSamePointsAtScaledPixelAreas)
{
  const PinholeCamera camera = someCamera();
  const PinholeCamera half = camera.scaled(0.5);
  EXPECT_EQ(half.width, 320);
  EXPECT_EQ(half.height, 240);
  const Eigen::Vector3d p(0.2, -0.1, 1.3);
  // The outer corner of pixel (0, 0) is at -0.5 in every resolution.
  const Eigen::Vector2d expected = (camera.project(p).array() + 0.5) * 0.5 - 0.5;
  EXPECT_TRUE(half.project(p).isApprox(expected, 1e-12));
  const PinholeCamera back = half.scaled(2);
  EXPECT_NEAR(back.cx, camera.cx, 1e-12);
  EXPECT_NEAR(back.fy, camera.fy, 1e-12);
}

TEST(PinholeCamera, DistortedOnlyWithACoefficient)
{
  PinholeCamera camera = someCamera();
  EXPECT_FALSE(camera.distorted());
  camera.distortion = { 0, 0, 0, 0, 0 };
  EXPECT_FALSE(camera.distorted());
  camera.distortion[3] = 1e-3;
  EXPECT_TRUE(camera.distorted());
}

TEST(PinholeCamera, ViolationsNameTheField)
{
  EXPECT_TRUE(someCamera().violations().empty());
  const auto first = [](const PinholeCamera& camera)
  {
    const std::vector<std::string> all = camera.violations();
    return all.empty() ? std::string() : all.front();
  };
  EXPECT_EQ(test_support::namesOf(PinholeCamera().violations()),
            (std::vector<std::string>{ "fx", "fy", "height", "width" }));
  PinholeCamera camera = someCamera();
  camera.width = -3;
  EXPECT_NE(first(camera).find("camera/width = -3"), std::string::npos);
  camera = someCamera();
  camera.fy = 0;
  EXPECT_NE(first(camera).find("camera/fy = 0"), std::string::npos);
  camera = someCamera();
  camera.cx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(first(camera).find("camera/cx"), std::string::npos);
  camera = someCamera();
  camera.distortion = { 0.1, 0.2, 0.3 };
  EXPECT_NE(first(camera).find("3 coefficients"), std::string::npos);
  camera.distortion = { 0.1, 0.2, 0, 0, std::numeric_limits<double>::infinity() };
  EXPECT_NE(first(camera).find("distortion"), std::string::npos);
  for (const std::size_t count : { 0, 4, 5, 8 })
  {
    camera.distortion.assign(count, 0.01);
    EXPECT_TRUE(camera.violations().empty()) << count;
  }
}

TEST(PinholeCamera, Equality)
{
  PinholeCamera other = someCamera();
  EXPECT_TRUE(other == someCamera());
  other.distortion = { 0, 0, 0, 0, 0.1 };
  EXPECT_FALSE(other == someCamera());
}

}  // namespace
}  // namespace object_modelling::geometry
