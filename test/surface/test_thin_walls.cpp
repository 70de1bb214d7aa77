#include "thin_walls.h"

#include <gtest/gtest.h>

namespace object_modelling::surface
{
namespace
{
constexpr float STEP_M = 0.002f, MIN_THICKNESS_M = 0.003f;

/// A square of 2 mm spacing at a height, its normals up or down.
void addPlane(float z_m, float normal_z, std::vector<Eigen::Vector3f>* points, std::vector<Eigen::Vector3f>* normals)
{
  for (int u = 0; u < 20; ++u)
    for (int v = 0; v < 20; ++v)
    {
      points->emplace_back(STEP_M * static_cast<float>(u), STEP_M * static_cast<float>(v), z_m);
      normals->emplace_back(0, 0, normal_z);
    }
}

std::vector<float> spreadOf(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals)
{
  return spreadOfWalls_m(points, normals, geometry::PointIndex(points), MIN_THICKNESS_M);
}

TEST(ThinWalls, SidesAreSpreadToTheThicknessAskedFor)
{
  std::vector<Eigen::Vector3f> points, normals;
  addPlane(0, 1, &points, &normals);
  addPlane(-0.001f, -1, &points, &normals);
  for (const float spread_m : spreadOf(points, normals))
    EXPECT_NEAR(spread_m, 0.001f, 1e-6f);
}

TEST(ThinWalls, ThickWallsAndSingleSurfacesStay)
{
  std::vector<Eigen::Vector3f> points, normals;
  addPlane(0, 1, &points, &normals);
  for (const float spread_m : spreadOf(points, normals))
    EXPECT_EQ(spread_m, 0);
  addPlane(-0.004f, -1, &points, &normals);
  for (const float spread_m : spreadOf(points, normals))
    EXPECT_EQ(spread_m, 0);
}

TEST(ThinWalls, SurfacesThatFaceEachOtherAreNoWall)
{
  std::vector<Eigen::Vector3f> points, normals;
  addPlane(0.001f, -1, &points, &normals);
  addPlane(0, 1, &points, &normals);
  for (const float spread_m : spreadOf(points, normals))
    EXPECT_EQ(spread_m, 0);
}

TEST(ThinWalls, MeshOfSpreadPointsGoesBackToWhereTheyWere)
{
  std::vector<Eigen::Vector3f> points, normals;
  addPlane(0, 1, &points, &normals);
  addPlane(-0.001f, -1, &points, &normals);
  const std::vector<float> spread_m = spreadOf(points, normals);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] += spread_m[i] * normals[i];
  mesh::TriangleMesh mesh;
  mesh.vertices = { { 0.011f, 0.011f, 0.001f },  { 0.019f, 0.011f, 0.001f },  { 0.011f, 0.019f, 0.001f },
                    { 0.011f, 0.011f, -0.002f }, { 0.011f, 0.019f, -0.002f }, { 0.019f, 0.011f, -0.002f } };
  mesh.triangles = { { 0, 1, 2 }, { 3, 4, 5 } };
  mesh::computeNormals(&mesh);
  takeSpreadBack(points, normals, spread_m, &mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_NEAR(mesh.vertices[i].z(), i < 3 ? 0 : -0.001f, 1e-6f) << i;
}
}  // namespace
}  // namespace object_modelling::surface
