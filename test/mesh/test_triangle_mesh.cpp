#include "object_modelling/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

namespace object_modelling::mesh
{
namespace
{
/// Unit cube from the origin, triangles counter-clockwise from outside.
TriangleMesh unitCube()
{
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  mesh.triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 4, 5, 6 }, { 5, 7, 6 }, { 0, 1, 4 }, { 1, 5, 4 },
                     { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 }, { 1, 3, 5 }, { 3, 7, 5 } };
  return mesh;
}

TEST(TriangleMesh, AreaOfACube)
{
  EXPECT_NEAR(surfaceArea_m2(unitCube()), 6, 1e-12);
  EXPECT_EQ(surfaceArea_m2(TriangleMesh()), 0);
}

TEST(TriangleMesh, NormalsPointOutwards)
{
  TriangleMesh mesh = unitCube();
  computeNormals(&mesh);
  ASSERT_EQ(mesh.normals.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i)
  {
    EXPECT_NEAR(mesh.normals[i].norm(), 1, 1e-6);
    EXPECT_GT(mesh.normals[i].dot(mesh.vertices[i] - Eigen::Vector3f::Constant(0.5f)), 0.5f) << i;
  }
}

TEST(TriangleMesh, NormalsAreWeightedByArea)
{
  TriangleMesh mesh;
  mesh.vertices = { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 }, { 0, 0, 1 }, { 1, 0, 0 } };
  mesh.triangles = { { 0, 1, 2 }, { 0, 3, 4 } };  // areas 4.5 along +z, 0.5 along +y
  computeNormals(&mesh);
  EXPECT_TRUE(mesh.normals[0].isApprox(Eigen::Vector3f(0, 1, 9).normalized(), 1e-6f));
}

TEST(TriangleMesh, NormalsOfLooseAndDegenerateVerticesAreUnit)
{
  TriangleMesh mesh;
  mesh.vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 5, 5, 5 } };
  mesh.triangles = { { 0, 1, 2 } };
  computeNormals(&mesh);
  for (const Eigen::Vector3f& normal : mesh.normals)
    EXPECT_NEAR(normal.norm(), 1, 1e-6);
}

TEST(TriangleMesh, TransformMovesVerticesAndTurnsNormals)
{
  TriangleMesh mesh = unitCube();
  computeNormals(&mesh);
  const TriangleMesh before = mesh;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(1, 2, 3)).rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  transform(T, &mesh);
  EXPECT_TRUE(mesh.vertices[1].isApprox(Eigen::Vector3f(1, 3, 3), 1e-6f));
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_TRUE(mesh.normals[i].isApprox(T.linear().cast<float>() * before.normals[i], 1e-6f));
  transform(T.inverse(), &mesh);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_TRUE((mesh.vertices[i] - before.vertices[i]).norm() < 1e-5f);
  EXPECT_NEAR(surfaceArea_m2(mesh), 6, 1e-5);
}

}  // namespace
}  // namespace object_modelling::mesh
