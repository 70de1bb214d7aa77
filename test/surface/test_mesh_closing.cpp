#include "../../src/surface/mesh_closing.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "object_modelling/mesh/mesh_check.h"

namespace object_modelling::surface
{
namespace
{
constexpr int SIDE = 41;
constexpr float EDGE_M = 0.001F;

/// A grid of SIDE x SIDE vertices, EDGE_M apart.
mesh::TriangleMesh grid()
{
  mesh::TriangleMesh mesh;
  for (int y = 0; y < SIDE; ++y)
    for (int x = 0; x < SIDE; ++x)
      mesh.vertices.emplace_back(EDGE_M * static_cast<float>(x), EDGE_M * static_cast<float>(y), 0);
  for (int y = 0; y + 1 < SIDE; ++y)
    for (int x = 0; x + 1 < SIDE; ++x)
    {
      const auto a = static_cast<std::uint32_t>(y * SIDE + x);
      mesh.triangles.push_back({ a, a + 1, a + SIDE });
      mesh.triangles.push_back({ a + 1, a + SIDE + 1, a + SIDE });
    }
  return mesh;
}

/// Marks all x below `left` and from `right` on.
std::vector<char> sides(int left, int right)
{
  std::vector<char> marks(SIDE * SIDE);
  for (int i = 0; i < SIDE * SIDE; ++i)
    marks[i] = static_cast<char>(i % SIDE < left || i % SIDE >= right);
  return marks;
}

int count(const std::vector<char>& marks)
{
  return static_cast<int>(std::count(marks.begin(), marks.end(), 1));
}
}  // namespace

TEST(MeshClosing, ClosesGapsThatAreNarrowEnough)
{
  const mesh::TriangleMesh mesh = grid();
  EXPECT_EQ(count(closedMarks(mesh, sides(10, 15), 0.0041)), SIDE * SIDE) << "5 mm wide, all along";
  EXPECT_EQ(closedMarks(mesh, sides(10, 30), 0.0041), sides(10, 30)) << "20 mm wide";
}

TEST(MeshClosing, DoesNotGrowOverARim)
{
  const mesh::TriangleMesh mesh = grid();
  EXPECT_EQ(closedMarks(mesh, sides(20, SIDE), 0.0061), sides(20, SIDE));
}

TEST(MeshClosing, CutsTeethOff)
{
  const mesh::TriangleMesh mesh = grid();
  std::vector<char> marks = sides(20, SIDE);
  for (int x = 20; x < 26; ++x)
    marks[10 * SIDE + x] = 1;  // one vertex wide
  const std::vector<char> opened = openedMarks(mesh, marks, 0.0011);
  EXPECT_LE(count(opened), count(sides(20, SIDE)) + 1) << "its foot may stay";
  EXPECT_GE(count(opened), count(sides(20, SIDE)));
  EXPECT_EQ(count(openedMarks(mesh, std::vector<char>(SIDE * SIDE, 1), 0.0011)), SIDE * SIDE) << "no rim, no teeth";
}

TEST(MeshClosing, TakesNothingAndAll)
{
  const mesh::TriangleMesh mesh = grid();
  const std::vector<char> none(SIDE * SIDE, 0), all(SIDE * SIDE, 1);
  EXPECT_EQ(closedMarks(mesh, none, 0.01), none);
  EXPECT_EQ(closedMarks(mesh, all, 0.01), all);
  EXPECT_EQ(openedMarks(mesh, none, 0.01), none);
  EXPECT_TRUE(closedMarks({}, {}, 0.01).empty());
}

TEST(MeshClosing, ClosesHolesOfFewEdgesAndNoOthers)
{
  const mesh::TriangleMesh whole = grid();
  const std::size_t rim = mesh::checkMesh(whole).boundary_edge_count;
  for (const std::size_t missing : { 1, 2, 40 })
  {
    mesh::TriangleMesh mesh = whole;
    const auto first = mesh.triangles.begin() + 20 * 2 * (SIDE - 1) + 30;  // in the middle
    mesh.triangles.erase(first, first + static_cast<std::ptrdiff_t>(missing));
    closeTinyHoles(8, &mesh);
    const mesh::MeshCheck check = mesh::checkMesh(mesh);
    if (missing < 3)
      EXPECT_EQ(check.boundary_edge_count, rim);
    else
      EXPECT_GT(check.boundary_edge_count, rim);
    EXPECT_EQ(check.misoriented_edge_count, 0u);
    EXPECT_EQ(check.non_manifold_edge_count, 0u);
  }
  mesh::TriangleMesh triangle;
  triangle.vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  triangle.triangles = { { 0, 1, 2 } };
  closeTinyHoles(2, &triangle);
  EXPECT_EQ(triangle.triangles.size(), 1u);
}

}  // namespace object_modelling::surface
