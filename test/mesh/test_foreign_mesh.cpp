#include "object_modelling/mesh/foreign_mesh.h"

#include <gtest/gtest.h>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/mesh/mesh_check.h"
#include "object_modelling/mesh/textured_mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::mesh
{
namespace
{
constexpr char TETRAHEDRON_STL[] = R"(solid t
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 10 0
vertex 10 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 10 0 0
vertex 0 0 10
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 10
vertex 0 10 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 10 0 0
vertex 0 10 0
vertex 0 0 10
endloop
endfacet
endsolid t
)";

constexpr char TETRAHEDRON_PLY[] = R"(ply
format ascii 1.0
element vertex 4
property double x
property double y
property double z
property uchar red
property uchar green
property uchar blue
element face 4
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
10 0 0 0 255 0
0 10 0 0 0 255
0 0 10 9 9 9
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
)";
}  // namespace

TEST(ForeignMesh, CornersOfStlAreJoined)
{
  const test_support::TempDir folder;
  const std::string path = folder.path("t.stl");
  base::writeTextFile(path, TETRAHEDRON_STL);
  const TexturedMesh read = readForeignMesh(path);
  EXPECT_EQ(read.mesh.vertices.size(), 4u);
  EXPECT_TRUE(checkMesh(read.mesh).watertight());
  EXPECT_NEAR(checkMesh(read.mesh).volume_m3, 1000.0 / 6, 1e-3);
  EXPECT_TRUE(read.uvs.empty());
  EXPECT_TRUE(read.texture_bgr.empty());
}

TEST(ForeignMesh, PlyInDoublesKeepsItsColors)
{
  const test_support::TempDir folder;
  const std::string path = folder.path("t.PLY");
  base::writeTextFile(path, TETRAHEDRON_PLY);
  const TexturedMesh read = readForeignMesh(path);
  ASSERT_EQ(read.mesh.vertices.size(), 4u);
  ASSERT_EQ(read.mesh.colors.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    if (read.mesh.vertices[i].x() > 5)
    {
      EXPECT_EQ(read.mesh.colors[i][1], 255);
    }
}

TEST(ForeignMesh, TextureComesAlong)
{
  const test_support::TempDir folder;
  TexturedMesh textured;
  test_support::addBox({ 0, 0, 0 }, { 0.1f, 0.1f, 0.1f }, 1, &textured.mesh);
  textured.uvs.assign(textured.mesh.triangles.size(),
                      { Eigen::Vector2f(0.1f, 0.1f), Eigen::Vector2f(0.9f, 0.1f), Eigen::Vector2f(0.5f, 0.9f) });
  textured.texture_bgr = cv::Mat(16, 16, CV_8UC3, cv::Scalar(10, 200, 90));
  computeNormals(&textured.mesh);
  for (const std::string name : { "box.obj", "box.glb" })
  {
    writeTexturedMesh(folder.path(name), textured);
    const TexturedMesh read = readForeignMesh(folder.path(name));
    EXPECT_EQ(read.mesh.triangles.size(), 12u) << name;
    EXPECT_EQ(read.uvs.size(), 12u) << name;
    EXPECT_EQ(read.mesh.vertices.size(), 8u) << name;
    EXPECT_EQ(read.mesh.colors.at(0), (Eigen::Matrix<std::uint8_t, 3, 1>(90, 200, 10))) << name;
    const TexturedMesh fine = subdivided(read, 0.03, 100000);
    EXPECT_EQ(fine.mesh.triangles.size(), 12u * 64);
    EXPECT_EQ(fine.uvs.size(), fine.mesh.triangles.size());
    EXPECT_EQ(fine.mesh.colors.size(), fine.mesh.vertices.size());
    EXPECT_TRUE(checkMesh(fine.mesh).watertight());
    EXPECT_EQ(subdivided(read, 0.03, 50).mesh.triangles.size(), 48u);
  }
}

TEST(ForeignMesh, WhatIsNoneIsRefused)
{
  const test_support::TempDir folder;
  const auto codeOf = [&](const std::string& name)
  { return test_support::statusOf([&] { readForeignMesh(folder.path(name)); }).code; };
  EXPECT_EQ(codeOf("missing.stl"), base::StatusCode::NOT_FOUND);
  base::writeTextFile(folder.path("notes.txt"), "no mesh");
  base::writeTextFile(folder.path("empty.obj"), "v 0 0 0\nv 1 0 0\n");
  base::writeTextFile(folder.path("cut.ply"), std::string(TETRAHEDRON_PLY).substr(0, 150));
  for (const std::string name : { "notes.txt", "empty.obj", "cut.ply" })
    EXPECT_EQ(codeOf(name), base::StatusCode::BAD_INPUT) << name;
}

}  // namespace object_modelling::mesh
