#include "object_modelling/mesh/decimation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/mesh/mesh_check.h"

namespace object_modelling::mesh
{
namespace
{
constexpr int SIDE = 40;
constexpr float STEP_M = 0.002f;

/// Grid over x and y, bent into waves of the given height along x.
TriangleMesh sheet(float wave_m)
{
  TriangleMesh mesh;
  for (int y = 0; y <= SIDE; ++y)
    for (int x = 0; x <= SIDE; ++x)
    {
      const float u = STEP_M * static_cast<float>(x), v = STEP_M * static_cast<float>(y);
      mesh.vertices.emplace_back(u, v, wave_m * std::sin(200 * u));
      mesh.colors.push_back({ static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 7 });
      mesh.seen.push_back(x < SIDE / 2 ? 1 : 0);
    }
  for (std::uint32_t y = 0; y < SIDE; ++y)
    for (std::uint32_t x = 0; x < SIDE; ++x)
    {
      const std::uint32_t i = y * (SIDE + 1) + x;
      mesh.triangles.push_back({ i, i + 1, i + SIDE + 2 });
      mesh.triangles.push_back({ i, i + SIDE + 2, i + SIDE + 1 });
    }
  return mesh;
}
}  // namespace

TEST(Decimation, FlatSheetNeedsFewTriangles)
{
  DecimationOptions options;
  options.max_triangles = 100;
  const DecimationResult result = decimate(sheet(0), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_LE(result.mesh.triangles.size(), 100u);
  EXPECT_GE(result.mesh.triangles.size(), 2u);
  EXPECT_TRUE(checkMesh(result.mesh).manifold());
  for (const Eigen::Vector3f& normal : result.mesh.normals)
    EXPECT_GT(normal.z(), 0.999f);
}

TEST(Decimation, WhatStaysKeepsItsColorAndMark)
{
  DecimationOptions options;
  options.max_triangles = 400;
  const TriangleMesh reduced = decimate(sheet(0.001f), options).mesh;
  ASSERT_EQ(reduced.colors.size(), reduced.vertices.size());
  ASSERT_EQ(reduced.seen.size(), reduced.vertices.size());
  for (std::size_t i = 0; i < reduced.vertices.size(); ++i)
  {
    const auto x = static_cast<int>(std::lround(reduced.vertices[i].x() / STEP_M));
    EXPECT_EQ(reduced.colors[i][0], x);
    EXPECT_EQ(reduced.colors[i][1], std::lround(reduced.vertices[i].y() / STEP_M));
    EXPECT_EQ(reduced.seen[i], x < SIDE / 2 ? 1 : 0);
  }
}

TEST(Decimation, ErrorLimitsTheBudget)
{
  DecimationOptions options;
  options.max_triangles = 10;
  options.max_error_m = 0.0002;
  const TriangleMesh waves = sheet(0.004f);
  const DecimationResult tight = decimate(waves, options);
  EXPECT_EQ(tight.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(tight.status.message.find("0.2"), std::string::npos) << tight.status.message;
  EXPECT_LT(tight.mesh.triangles.size(), waves.triangles.size());
  options.max_error_m = 0.002;
  EXPECT_LT(2 * decimate(waves, options).mesh.triangles.size(), tight.mesh.triangles.size());
}

TEST(Decimation, LeavesSmallMeshesAndRefusesBrokenOnes)
{
  DecimationOptions options;
  options.max_triangles = 1000000;
  EXPECT_EQ(decimate(sheet(0), options).mesh.triangles.size(), 2u * SIDE * SIDE);
  TriangleMesh fin = sheet(0);
  fin.triangles.push_back({ 0, 1, SIDE + 2 });
  options.max_triangles = 10;
  EXPECT_THROW(decimate(fin, options), base::Error);
  options.max_error_m = 0;
  EXPECT_THROW(decimate(sheet(0), options), base::Error);
}

}  // namespace object_modelling::mesh
