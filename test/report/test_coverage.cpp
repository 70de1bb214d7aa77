#include "object_modelling/report/coverage.h"

#include <cmath>

#include <gtest/gtest.h>

namespace object_modelling::report
{
namespace
{
constexpr float HALF_M = 0.05f;

/// Square of n x n points at z = HALF_M, facing up, and another one at -HALF_M, facing down.
mesh::TriangleMesh twoSides(int n)
{
  mesh::TriangleMesh mesh;
  for (const float z : { HALF_M, -HALF_M })
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
      {
        mesh.vertices.push_back({ 0.08f * static_cast<float>(i) / static_cast<float>(n - 1) - 0.04f,
                                  0.08f * static_cast<float>(j) / static_cast<float>(n - 1) - 0.04f, z });
        mesh.normals.push_back({ 0, 0, z > 0 ? 1.f : -1.f });
      }
  mesh.triangles = { { 0, 1, 2 } };
  return mesh;
}

/// From 0.5 m above the origin straight down; `depth_m` everywhere.
rgbd::View fromAbove(float depth_m)
{
  rgbd::View view;
  view.frame.camera = { 160, 120, 200, 200, 79.5, 59.5, {} };
  view.frame.depth_m = cv::Mat(120, 160, CV_32FC1, cv::Scalar(depth_m));
  view.T_world_camera.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
  view.T_world_camera.translation().z() = 0.5;
  return view;
}
}  // namespace

TEST(CoverageTest, CountsWhatTheDepthAgreesWith)
{
  const mesh::TriangleMesh mesh = twoSides(11);
  const float top_m = 0.5f - HALF_M;
  const Coverage one = coverageOf(mesh, { fromAbove(top_m) });
  EXPECT_DOUBLE_EQ(one.seen_ratio, 0.5);  // the side that faces the camera
  EXPECT_DOUBLE_EQ(one.well_seen_ratio, 0);
  const Coverage three = coverageOf(mesh, { fromAbove(top_m), fromAbove(top_m), fromAbove(top_m) });
  EXPECT_DOUBLE_EQ(three.well_seen_ratio, 0.5);
  EXPECT_EQ(coverageOf(mesh, { fromAbove(top_m - 0.05f) }).seen_ratio, 0);  // something stands before it
  EXPECT_EQ(coverageOf(mesh, { fromAbove(NAN) }).seen_ratio, 0);
}

TEST(CoverageTest, MapsTheDirections)
{
  const Coverage coverage = coverageOf(twoSides(3), { fromAbove(1) });
  for (int column = 0; column < AZIMUTH_BINS; ++column)
  {
    EXPECT_EQ(coverage.view_counts[ELEVATION_BINS - 1][column], 1);
    EXPECT_EQ(coverage.view_counts[ELEVATION_BINS - 2][column], 1);
    EXPECT_EQ(coverage.view_counts[ELEVATION_BINS - 3][column], 0);  // centred 37.5 deg off
    EXPECT_EQ(coverage.view_counts[0][column], 0);
  }
  // The cap of 30 degrees is (1 - cos 30) of a half sphere.
  EXPECT_NEAR(coverage.upper_direction_ratio, 1 - std::cos(VIEW_CONE_RAD), 0.01);
  EXPECT_NEAR(coverage.direction_ratio, coverage.upper_direction_ratio / 2, 1e-12);
}

TEST(CoverageTest, NothingIsNothing)
{
  const Coverage coverage = coverageOf({}, {});
  EXPECT_EQ(coverage.seen_ratio, 0);
  EXPECT_EQ(coverage.direction_ratio, 0);
}

}  // namespace object_modelling::report
