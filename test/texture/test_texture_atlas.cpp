#include <cmath>

#include <gtest/gtest.h>

#include "atlas.h"
#include "color_fill.h"
#include "object_modelling/base/status.h"
#include "object_modelling/mesh/mesh_topology.h"
#include "object_modelling/mesh/triangle_raster.h"
#include "texture_scene.h"

namespace object_modelling::texture
{
namespace
{
/// A sphere with dents: all directions, folds under any projection.
mesh::TriangleMesh dentedSphere()
{
  constexpr int ROWS = 40, COLUMNS = 80;
  mesh::TriangleMesh mesh;
  const auto index = [](int row, int column) { return static_cast<std::uint32_t>(row * COLUMNS + column % COLUMNS); };
  for (int row = 0; row <= ROWS; ++row)
    for (int column = 0; column < COLUMNS; ++column)
    {
      const double latitude = (static_cast<double>(row) / ROWS - 0.5) * 0.99 * M_PI;
      const double longitude = 2 * M_PI * column / COLUMNS;
      const double radius_m = 0.05 * (1 + 0.35 * std::cos(5 * longitude) * std::cos(latitude));
      mesh.vertices.push_back((radius_m * Eigen::Vector3d(std::cos(latitude) * std::cos(longitude),
                                                          std::cos(latitude) * std::sin(longitude), std::sin(latitude)))
                                  .cast<float>());
    }
  for (int row = 0; row < ROWS; ++row)
    for (int column = 0; column < COLUMNS; ++column)
    {
      mesh.triangles.push_back({ index(row, column), index(row, column + 1), index(row + 1, column + 1) });
      mesh.triangles.push_back({ index(row, column), index(row + 1, column + 1), index(row + 1, column) });
    }
  return mesh;
}

TEST(TextureAtlas, HoldsEveryTriangleOnceWithoutOverlaps)
{
  constexpr int PADDING_PX = 3;
  const mesh::TriangleMesh mesh = dentedSphere();
  const std::vector<Chart> charts = makeCharts(mesh, 0.0005);
  EXPECT_LT(charts.size(), 60u);
  const Atlas atlas = packCharts(charts, mesh.triangles.size(), 0.0005, PADDING_PX, 4096);
  EXPECT_DOUBLE_EQ(atlas.texel_size_m, 0.0005);
  cv::Mat chart_at(atlas.size_px, CV_32SC1, cv::Scalar(-1)), covered = cv::Mat::zeros(atlas.size_px, CV_8UC1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    ASSERT_GE(atlas.chart[t], 0);
    for (const Eigen::Vector2f& corner : atlas.texels[t])
    {
      EXPECT_GE(corner.minCoeff(), PADDING_PX - 1e-3f);
      EXPECT_LE(corner.x(), static_cast<float>(atlas.size_px.width - PADDING_PX));
      EXPECT_LE(corner.y(), static_cast<float>(atlas.size_px.height - PADDING_PX));
    }
    mesh::forEachPixelInside(atlas.texels[t], mesh::ON_EDGE_SHARE, atlas.size_px,
                             [&](int u, int v, const Eigen::Vector3f&)
                             {
                               ++covered.at<std::uint8_t>(v, u);
                               chart_at.at<int>(v, u) = atlas.chart[t];
                             });
  }
  double most = 0;
  cv::minMaxLoc(covered, nullptr, &most);
  EXPECT_EQ(most, 1);
  // Charts keep their padding free of others.
  for (int v = 0; v + PADDING_PX < chart_at.rows; ++v)
    for (int u = 0; u + PADDING_PX < chart_at.cols; ++u)
      if (chart_at.at<int>(v, u) >= 0)
      {
        EXPECT_TRUE(chart_at.at<int>(v, u + PADDING_PX) < 0 ||
                    chart_at.at<int>(v, u + PADDING_PX) == chart_at.at<int>(v, u));
        EXPECT_TRUE(chart_at.at<int>(v + PADDING_PX, u) < 0 ||
                    chart_at.at<int>(v + PADDING_PX, u) == chart_at.at<int>(v, u));
      }
}

TEST(TextureAtlas, KeepsLengthsOfABox)
{
  const mesh::TriangleMesh mesh = boxMesh(0.01, true);
  const std::vector<Chart> charts = makeCharts(mesh, 0.001);
  ASSERT_EQ(charts.size(), 6u);
  const Atlas atlas = packCharts(charts, mesh.triangles.size(), 0.001, 2, 4096);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
    {
      const double length_m =
          (mesh.vertices[mesh.triangles[t][k]] - mesh.vertices[mesh.triangles[t][(k + 1) % 3]]).norm();
      EXPECT_NEAR((atlas.texels[t][k] - atlas.texels[t][(k + 1) % 3]).norm() * 0.001, length_m, 1e-5);
    }
}

TEST(TextureAtlas, CoarsensToFitAndSaysWhenItCannot)
{
  const mesh::TriangleMesh mesh = boxMesh(0.01, true);
  const std::vector<Chart> charts = makeCharts(mesh, 0.0005);
  const Atlas atlas = packCharts(charts, mesh.triangles.size(), 0.0005, 2, 128);
  EXPECT_LE(std::max(atlas.size_px.width, atlas.size_px.height), 128);
  EXPECT_GT(atlas.texel_size_m, 0.001);
  EXPECT_THROW(packCharts(charts, mesh.triangles.size(), 0.0005, 60, 128), base::Error);
}

TEST(TextureAtlas, TakesTrianglesWithoutArea)
{
  mesh::TriangleMesh mesh;
  mesh.vertices = { { 0, 0, 0 }, { 0.01f, 0, 0 }, { 0, 0.01f, 0 }, { 0.02f, 0, 0 } };
  mesh.triangles = { { 0, 1, 2 }, { 0, 1, 3 } };
  std::size_t triangles = 0;
  for (const Chart& chart : makeCharts(mesh, 0.001))
    triangles += chart.triangles.size();
  EXPECT_EQ(triangles, 2u);
}

TEST(ColorFill, StretchesBetweenKnownColors)
{
  const mesh::TriangleMesh mesh = boxMesh(0.01, true);
  std::vector<char> known(mesh.vertices.size(), 0);
  std::vector<Eigen::Vector3f> colors(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    const float z = mesh.vertices[i].z();
    known[i] = z < 1e-4f || z > BOX_HEIGHT_M - 1e-4;
    colors[i] = known[i] ? Eigen::Vector3f::Constant(z > 0.05f ? 200.f : 100.f) : Eigen::Vector3f::Zero();
  }
  fillHarmonically(mesh, known, &colors);
  const auto neighbors = mesh::vertexNeighbors(mesh);
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    if (known[i])
      continue;
    float sum = 0;
    for (const std::uint32_t neighbor : neighbors[i])
      sum += colors[neighbor][1];
    EXPECT_NEAR(colors[i][1], sum / static_cast<float>(neighbors[i].size()), 0.01);
    EXPECT_GT(colors[i][1], 100);
    EXPECT_LT(colors[i][1], 200);
  }

  std::fill(known.begin(), known.end(), 0);
  fillHarmonically(mesh, known, &colors);
  EXPECT_NEAR(colors[0][0], 128, 1e-3);
}

}  // namespace
}  // namespace object_modelling::texture
