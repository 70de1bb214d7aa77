#include "../../src/surface/mesh_cleaning.h"

#include <gtest/gtest.h>

namespace object_modelling::surface
{
namespace
{
/// Two triangles that share an edge, unit square.
mesh::TriangleMesh square()
{
  mesh::TriangleMesh mesh;
  mesh.vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  mesh.colors = { { 1, 1, 1 }, { 2, 2, 2 }, { 3, 3, 3 }, { 4, 4, 4 } };
  mesh.triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  return mesh;
}

TEST(MeshCleaning, KeepsTrianglesOfKeptVerticesAndNoLooseVertex)
{
  mesh::TriangleMesh mesh = square();
  keepVertices({ 1, 0, 1, 1 }, &mesh);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{ 0, 1, 2 }));
  EXPECT_EQ(mesh.colors[1][0], 3);
  keepVertices({ 1, 1, 0 }, &mesh);
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(MeshCleaning, RemovesDegenerateAndRepeatedTriangles)
{
  mesh::TriangleMesh mesh = square();
  mesh.vertices.push_back({ 2, 0, 0 });
  mesh.triangles.push_back({ 0, 1, 4 });  // no area
  mesh.triangles.push_back({ 0, 1, 1 });
  mesh.triangles.push_back({ 1, 2, 0 });
  mesh.triangles.push_back({ 3, 2, 0 });
  removeDegenerateTriangles(&mesh);
  EXPECT_EQ(mesh.triangles, square().triangles);
}

TEST(MeshCleaning, RemovesSmallPieces)
{
  mesh::TriangleMesh mesh = square();
  mesh.colors.clear();
  mesh.vertices.insert(mesh.vertices.end(), { { 5, 0, 0 }, { 5.1f, 0, 0 }, { 5, 0.1f, 0 } });
  mesh.triangles.push_back({ 4, 5, 6 });
  mesh::TriangleMesh all = mesh;
  removeSmallPieces(0.02, &mesh);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, square().triangles);
  removeSmallPieces(0.004, &all);
  EXPECT_EQ(all.triangles.size(), 3u);
}

TEST(MeshCleaning, SplitsFansThatTouchInAVertex)
{
  mesh::TriangleMesh mesh = square();
  mesh.colors.clear();
  mesh.vertices.insert(mesh.vertices.end(), { { -1, 0, 0 }, { -1, -1, 0 } });
  mesh.triangles.push_back({ 0, 4, 5 });
  splitTouchingFans(&mesh);
  ASSERT_EQ(mesh.vertices.size(), 7u);
  EXPECT_EQ(mesh.vertices[6], mesh.vertices[0]);
  EXPECT_EQ(mesh.triangles[0], square().triangles[0]);
  EXPECT_EQ(mesh.triangles[1], square().triangles[1]);
  EXPECT_EQ(mesh.triangles[2], (std::array<std::uint32_t, 3>{ 6, 4, 5 }));
}

TEST(MeshCleaning, NothingIsFine)
{
  mesh::TriangleMesh mesh;
  keepVertices({}, &mesh);
  removeDegenerateTriangles(&mesh);
  removeSmallPieces(0.1, &mesh);
  splitTouchingFans(&mesh);
  EXPECT_TRUE(mesh.vertices.empty());
}

}  // namespace
}  // namespace object_modelling::surface
