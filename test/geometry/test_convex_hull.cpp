#include "object_modelling/geometry/convex_hull.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace object_modelling::geometry
{
TEST(HullSurface, OfACubeWithPointsInsideAndOnItsFaces)
{
  std::vector<Eigen::Vector3f> points;
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 4; ++y)
      for (int z = 0; z <= 4; ++z)
        points.emplace_back(0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y), 0.1f * static_cast<float>(z));
  const HullSurface hull = hullSurface(points);
  EXPECT_NEAR(hull.volume_m3(), 0.064, 1e-7);
  const Eigen::Vector3f center(0.2f, 0.2f, 0.2f);
  for (const auto& [a, b, c] : hull.triangles)
  {
    const Eigen::Vector3f origin = hull.vertices[a];
    EXPECT_GE((hull.vertices[b] - origin).cross(hull.vertices[c] - origin).dot(origin - center), 0);
  }
}

TEST(HullSurface, OfABallNearlyAllPointsAreCorners)
{
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 2000; ++i)
    points.push_back(Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized());
  const HullSurface hull = hullSurface(points);
  EXPECT_GT(hull.vertices.size(), 1990u);
  EXPECT_EQ(hull.triangles.size(), 2 * hull.vertices.size() - 4);
  EXPECT_NEAR(hull.volume_m3(), 4.0 / 3 * M_PI, 0.03);
}

TEST(HullSurface, OfFlatPointsThereIsNone)
{
  EXPECT_TRUE(hullSurface({}).triangles.empty());
  EXPECT_TRUE(hullSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } }).triangles.empty());
}

}  // namespace object_modelling::geometry
