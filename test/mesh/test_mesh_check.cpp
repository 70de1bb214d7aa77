#include "object_modelling/mesh/mesh_check.h"

#include <gtest/gtest.h>

#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
TriangleMesh tetrahedron()
{
  TriangleMesh mesh;
  mesh.vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  mesh.triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };
  return mesh;
}
}  // namespace

TEST(MeshCheck, ClosedSolidIsWatertight)
{
  const MeshCheck check = checkMesh(tetrahedron());
  EXPECT_TRUE(check.watertight());
  EXPECT_EQ(check.piece_count, 1u);
  EXPECT_NEAR(check.volume_m3, 1.0 / 6, 1e-9);
}

TEST(MeshCheck, InsideOutIsNotWatertight)
{
  TriangleMesh mesh = tetrahedron();
  for (auto& triangle : mesh.triangles)
    std::swap(triangle[0], triangle[1]);
  const MeshCheck check = checkMesh(mesh);
  EXPECT_TRUE(check.manifold());
  EXPECT_LT(check.volume_m3, 0);
  EXPECT_FALSE(check.watertight());
}

TEST(MeshCheck, CountsWhatIsWrong)
{
  TriangleMesh open = tetrahedron();
  open.triangles.pop_back();
  EXPECT_EQ(checkMesh(open).boundary_edge_count, 3u);
  EXPECT_TRUE(checkMesh(open).manifold());

  TriangleMesh turned = tetrahedron();
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_EQ(checkMesh(turned).misoriented_edge_count, 3u);
  EXPECT_FALSE(checkMesh(turned).manifold());

  TriangleMesh fin = tetrahedron();
  fin.vertices.emplace_back(1, 1, -1);
  fin.triangles.push_back({ 1, 2, 4 });
  EXPECT_EQ(checkMesh(fin).non_manifold_edge_count, 1u);

  TriangleMesh flat = tetrahedron();
  flat.triangles.push_back({ 0, 0, 1 });
  EXPECT_EQ(checkMesh(flat).degenerate_triangle_count, 1u);
}

TEST(MeshCheck, FindsSolidsThatTouchInOneVertex)
{
  TriangleMesh mesh = tetrahedron();
  const TriangleMesh other = tetrahedron();
  for (std::size_t i = 1; i < other.vertices.size(); ++i)
    mesh.vertices.emplace_back(-other.vertices[i]);
  for (auto triangle : other.triangles)
  {
    for (std::uint32_t& vertex : triangle)
      vertex += vertex > 0 ? 3 : 0;
    mesh.triangles.push_back({ triangle[0], triangle[2], triangle[1] });
  }
  const MeshCheck check = checkMesh(mesh);
  EXPECT_EQ(check.non_manifold_vertex_count, 1u);
  EXPECT_EQ(check.non_manifold_edge_count, 0u);
  EXPECT_FALSE(check.manifold());
}

TEST(MeshCheck, TakesEmptyMeshesAndRefusesBrokenOnes)
{
  EXPECT_TRUE(checkMesh({}).manifold());
  EXPECT_FALSE(checkMesh({}).watertight());
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({ 0, 1, 99 });
  EXPECT_THROW(checkMesh(mesh), base::Error);
}

}  // namespace object_modelling::mesh
