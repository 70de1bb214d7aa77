#include "object_modelling/mesh/mesh_files.h"

#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>

#include <gtest/gtest.h>

#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::mesh
{
namespace
{
/// Every colour value once, coordinates that need all digits.
TriangleMesh strip(bool normals = true, bool colors = true)
{
  TriangleMesh mesh;
  for (int i = 0; i < 256; ++i)
  {
    mesh.vertices.push_back({ 0.01f + 0.0012345678f * i, i % 2 ? 0.1f / 3 : -0.2f / 7, -0.5f + 1e-6f * i * i });
    if (normals)
      mesh.normals.push_back(Eigen::Vector3f(0.01f * i, 0.3f, 1).normalized());
    if (colors)
      mesh.colors.push_back(
          { static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i), static_cast<std::uint8_t>(i ^ 85) });
  }
  for (std::uint32_t i = 0; i + 2 < 256; ++i)
    mesh.triangles.push_back({ i, i + 1, i + 2 });
  return mesh;
}

base::StatusCode codeOf(const std::function<void()>& action)
{
  const base::Status status = test_support::statusOf(action);
  EXPECT_EQ(status.message.empty(), status.code == base::StatusCode::OK);
  return status.code;
}

std::string contentOf(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), {} };
}

void writeText(const std::string& path, const std::string& text)
{
  std::ofstream(path, std::ios::binary) << text;
}

class MeshFiles : public testing::TestWithParam<std::string>
{
protected:
  test_support::TempDir folder_;
};

TEST_P(MeshFiles, RoundTripKeepsGeometryNormalsAndColors)
{
  const TriangleMesh mesh = strip();
  const std::string path = folder_.path("strip" + GetParam());
  writeMesh(path, mesh);
  const TriangleMesh read = readMesh(path);
  ASSERT_EQ(read.vertices.size(), mesh.vertices.size());
  ASSERT_EQ(read.normals.size(), mesh.normals.size());
  ASSERT_EQ(read.colors.size(), mesh.colors.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    EXPECT_LT((read.vertices[i] - mesh.vertices[i]).norm(), 1e-6f) << i;
    EXPECT_LT((read.normals[i] - mesh.normals[i]).norm(), 1e-5f) << i;
    EXPECT_EQ(read.colors[i], mesh.colors[i]) << i;
  }
  EXPECT_EQ(read.triangles, mesh.triangles);
}

TEST_P(MeshFiles, RoundTripWithoutNormalsAndColors)
{
  const std::string path = folder_.path("strip" + GetParam());
  writeMesh(path, strip(false, false));
  const TriangleMesh read = readMesh(path);
  EXPECT_EQ(read.vertices.size(), 256u);
  EXPECT_EQ(read.triangles.size(), 254u);
  EXPECT_EQ(read.normals.empty(), GetParam() != ".obj");  // the OBJ exporter adds smooth normals
  EXPECT_TRUE(read.colors.empty());
}

TEST_P(MeshFiles, SameMeshGivesTheSameBytesAndLeavesNothingElse)
{
  writeMesh(folder_.path("a" + GetParam()), strip());
  writeMesh(folder_.path("b" + GetParam()), strip());
  EXPECT_EQ(contentOf(folder_.path("a" + GetParam())), contentOf(folder_.path("b" + GetParam())));
  EXPECT_FALSE(std::filesystem::exists(folder_.path("a" + GetParam() + ".part")));
}

TEST_P(MeshFiles, HostileNamesAreOrdinaryNames)
{
  for (const std::string name : { "with space", "quote'\"", "%s%n", "Ωmega", "$(touch x)", "-rf", "new\nline", "a.b" })
  {
    const std::string path = folder_.path(name + GetParam());
    writeMesh(path, strip());
    EXPECT_EQ(readMesh(path).triangles.size(), 254u) << name;
  }
}

TEST_P(MeshFiles, ReplacesAnOlderFile)
{
  const std::string path = folder_.path("mesh" + GetParam());
  writeText(path, "old");
  writeMesh(path, strip());
  EXPECT_EQ(readMesh(path).vertices.size(), 256u);
}

TEST_P(MeshFiles, UnwritablePlacesAreNamed)
{
  writeText(folder_.path("file"), "");
  std::filesystem::create_directory(folder_.path("folder" + GetParam()));
  for (const std::string place : { "missing/mesh", "file/mesh", "folder" })
  {
    const std::string path = folder_.path(place + GetParam());
    EXPECT_EQ(codeOf([&] { writeMesh(path, strip()); }), base::StatusCode::STORAGE) << path;
  }
}

TEST_P(MeshFiles, FullDiskIsAnErrorAndKeepsTheOldFile)
{
  if (!std::filesystem::exists("/dev/full"))
    GTEST_SKIP();
  const std::string path = folder_.path("mesh" + GetParam());
  writeText(path, "old");
  std::filesystem::create_symlink("/dev/full", path + ".part");
  EXPECT_EQ(codeOf([&] { writeMesh(path, strip()); }), base::StatusCode::STORAGE);
  EXPECT_EQ(contentOf(path), "old");
}

TEST_P(MeshFiles, RefusesMeshesThatAreNone)
{
  const std::string path = folder_.path("mesh" + GetParam());
  TriangleMesh out_of_range = strip(), not_finite = strip(), few_colors = strip();
  out_of_range.triangles[3][1] = 256;
  not_finite.vertices[7].x() = std::numeric_limits<float>::quiet_NaN();
  few_colors.colors.pop_back();
  for (const auto& mesh : { TriangleMesh(), out_of_range, not_finite, few_colors })
    EXPECT_EQ(codeOf([&] { writeMesh(path, mesh); }), base::StatusCode::INVALID_ARGUMENT);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_P(MeshFiles, MissingAndDamagedFiles)
{
  const std::string path = folder_.path("mesh" + GetParam());
  EXPECT_EQ(codeOf([&] { readMesh(path); }), base::StatusCode::NOT_FOUND);
  writeMesh(path, strip());
  const std::string whole = contentOf(path);
  for (const std::string& content : { std::string(), std::string("no mesh at all"), std::string(200, '\0') })
  {
    writeText(path, content);
    EXPECT_EQ(codeOf([&] { readMesh(path); }), base::StatusCode::BAD_INPUT) << content;
  }
  // A mesh cut short may be refused, or give the triangles that are complete; it must never be taken for more.
  for (std::size_t length = 1; length < whole.size(); length += whole.size() / 40)
  {
    writeText(path, whole.substr(0, length));
    const base::StatusCode code = codeOf([&] { EXPECT_LE(readMesh(path).triangles.size(), 254u); });
    EXPECT_TRUE(code == base::StatusCode::OK || code == base::StatusCode::BAD_INPUT) << length;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshFiles, testing::Values(".ply", ".obj", ".PLY"));

TEST(MeshFile, PlyKeepsWhatNoCameraSaw)
{
  const test_support::TempDir folder;
  TriangleMesh mesh = strip();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.seen.push_back(i % 3 == 0 ? 0 : 1);
  const std::string path = folder.path("closed.ply");
  writeMesh(path, mesh);
  const TriangleMesh read = readMesh(path);
  EXPECT_EQ(read.seen, mesh.seen);
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.normals, mesh.normals);
  EXPECT_EQ(read.colors, mesh.colors);
  EXPECT_EQ(read.triangles, mesh.triangles);
  const std::vector<float> sigmas_m(mesh.vertices.size(), 0.0005f);
  writeMesh(path, mesh, sigmas_m);
  EXPECT_EQ(readMesh(path).seen, mesh.seen);
  EXPECT_EQ(readMesh(path).colors, mesh.colors);
  EXPECT_EQ(codeOf([&] { writeMesh(path, mesh, { 1 }); }), base::StatusCode::INVALID_ARGUMENT);
  mesh.seen.pop_back();
  EXPECT_EQ(codeOf([&] { writeMesh(path, mesh); }), base::StatusCode::INVALID_ARGUMENT);
}

TEST(MeshFile, UnknownExtensionsAreRefused)
{
  const test_support::TempDir folder;
  for (const std::string name : { "mesh", "mesh.stl", "mesh.ply.txt", ".ply", "" })
  {
    EXPECT_EQ(codeOf([&] { writeMesh(folder.path(name), strip()); }), base::StatusCode::INVALID_ARGUMENT) << name;
    EXPECT_EQ(codeOf([&] { readMesh(folder.path(name)); }), base::StatusCode::INVALID_ARGUMENT) << name;
  }
}

TEST(MeshFile, ReadsPolygonsAndTexturedFilesOfOthers)
{
  const test_support::TempDir folder;
  writeText(
      folder.path("quad.ply"),
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  writeText(folder.path("quad.obj"),
            "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
            "f 1/1 2/2 3/3\nf 1/4 3/3 4/4\n");
  for (const std::string name : { "quad.ply", "quad.obj" })
  {
    const TriangleMesh mesh = readMesh(folder.path(name));
    EXPECT_EQ(mesh.vertices.size(), 4u) << name;
    EXPECT_EQ(mesh.triangles.size(), 2u) << name;
  }
}

}  // namespace
}  // namespace object_modelling::mesh
