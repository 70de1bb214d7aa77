#include "object_modelling/surface/surface_reconstruction.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "object_modelling/mesh/mesh_check.h"
#include "support/violations.h"

namespace object_modelling::surface
{
namespace
{
constexpr float RADIUS_M = 0.05f;

/// Points spread evenly over a sphere (spiral), without those below `floor_m`.
fusion::FusedCloud sphere(float floor_m = -1, const Eigen::Vector3f& center = Eigen::Vector3f::Zero())
{
  fusion::FusedCloud cloud;
  constexpr int COUNT = 8000;
  for (int i = 0; i < COUNT; ++i)
  {
    const double z = 1 - 2 * (i + 0.5) / COUNT, r = std::sqrt(1 - z * z), angle = i * 2.399963229728653;
    const Eigen::Vector3f n = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
    if (n.z() * RADIUS_M < floor_m)
      continue;
    cloud.points.push_back(center + RADIUS_M * n);
    cloud.normals.push_back(n);
    cloud.colors.push_back(n.z() > 0 ? Eigen::Matrix<std::uint8_t, 3, 1>(250, 0, 0)
                                     : Eigen::Matrix<std::uint8_t, 3, 1>(0, 0, 250));
    cloud.weights.push_back(1);
    cloud.sigmas_m.push_back(1e-4f);
  }
  return cloud;
}

SurfaceResult reconstruct(const fusion::FusedCloud& cloud, const SurfaceOptions& options = {},
                          const std::optional<geometry::Plane>& support = std::nullopt)
{
  base::JobControl control;
  return reconstructSurface(cloud, support, options, control);
}

/// Edges by how many triangles use them.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edgesOf(const mesh::TriangleMesh& mesh)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
      ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  return edges;
}

int boundaryEdges(const mesh::TriangleMesh& mesh)
{
  int count = 0;
  for (const auto& [edge, uses] : edgesOf(mesh))
  {
    EXPECT_LE(uses, 2) << "not a manifold";
    count += uses == 1;
  }
  return count;
}

TEST(SurfaceReconstruction, WholeSphereIsClosedAndExact)
{
  const Eigen::Vector3f center(0.3f, -0.2f, 1);
  const SurfaceResult result = reconstruct(sphere(-1, center));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const mesh::TriangleMesh& mesh = result.mesh;
  EXPECT_EQ(boundaryEdges(mesh), 0);
  EXPECT_NEAR(mesh::surfaceArea_m2(mesh), 4 * M_PI * RADIUS_M * RADIUS_M, 3e-4);
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    const Eigen::Vector3f d = mesh.vertices[i] - center;
    EXPECT_NEAR(d.norm(), RADIUS_M, 3e-4f);
    EXPECT_GT(mesh.normals[i].dot(d.normalized()), 0.9f) << "outward";
    if (std::abs(d.z()) > 0.005f)
    {
      EXPECT_EQ(mesh.colors[i][d.z() > 0 ? 0 : 2], 250);
    }
  }
}

TEST(SurfaceReconstruction, StaysOpenWhereNothingWasSeen)
{
  const float floor_m = -0.03f;
  const SurfaceResult result = reconstruct(sphere(floor_m));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_GT(boundaryEdges(result.mesh), 50);
  for (const Eigen::Vector3f& vertex : result.mesh.vertices)
  {
    EXPECT_GT(vertex.z(), floor_m - 0.004f);
    EXPECT_NEAR(vertex.norm(), RADIUS_M, 1e-3f);
  }
}

TEST(SurfaceReconstruction, SmallGapsAreClosed)
{
  fusion::FusedCloud cloud = sphere(), with_gap;
  for (std::size_t i = 0; i < cloud.size(); ++i)
  {
    if ((cloud.points[i] - Eigen::Vector3f(0, 0, RADIUS_M)).norm() < 0.004f)
      continue;
    with_gap.points.push_back(cloud.points[i]);
    with_gap.normals.push_back(cloud.normals[i]);
  }
  const SurfaceResult result = reconstruct(with_gap);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(boundaryEdges(result.mesh), 0);
  EXPECT_TRUE(result.mesh.colors.empty()) << "no colours in, none out";
}

/// Half a hollow ball whose wall is `wall_m` thick, with noise along the normals; the rim of the wall is not seen.
fusion::FusedCloud cup(float wall_m, float noise_m)
{
  const fusion::FusedCloud half = sphere(0);
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, noise_m);
  fusion::FusedCloud cloud;
  for (const float side : { 1.f, -1.f })
    for (std::size_t i = 0; i < half.size(); ++i)
    {
      const Eigen::Vector3f n = half.normals[i];
      cloud.points.push_back((RADIUS_M - (side < 0 ? wall_m : 0) + noise(random)) * n);
      cloud.normals.push_back(side * n);
      cloud.colors.push_back(half.colors[i]);
      cloud.weights.push_back(1);
      cloud.sigmas_m.push_back(1e-4f);
    }
  return cloud;
}

TEST(SurfaceReconstruction, ThinWallKeepsTwoSidesWithoutHoles)
{
  for (const float wall_m : { 0.0006f, 0.001f, 0.0025f })
  {
    const SurfaceResult result = reconstruct(cup(wall_m, 0.0002f));
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    double outer_area = 0, inner_area = 0, squares = 0;
    int counted = 0;
    for (const auto& [a, b, c] : result.mesh.triangles)
    {
      const Eigen::Vector3f &p = result.mesh.vertices[a], &q = result.mesh.vertices[b], &r = result.mesh.vertices[c];
      const Eigen::Vector3f middle = (p + q + r) / 3, cross = (q - p).cross(r - p);
      if (middle.z() < 0.01f)
        continue;
      const bool outside = cross.dot(middle) > 0;
      (outside ? outer_area : inner_area) += 0.5 * cross.norm();
      const float error_m = middle.norm() - (RADIUS_M - (outside ? 0 : wall_m));
      squares += error_m * error_m;
      ++counted;
    }
    const double outer = 2 * M_PI * RADIUS_M * (RADIUS_M - 0.01);
    const double inner_radius = RADIUS_M - wall_m, inner = 2 * M_PI * inner_radius * (inner_radius - 0.01);
    EXPECT_NEAR(outer_area, outer, 0.02 * outer) << wall_m;
    EXPECT_NEAR(inner_area, inner, 0.02 * inner) << wall_m;
    EXPECT_LT(std::sqrt(squares / counted), 0.0002) << wall_m;
  }
}

TEST(SurfaceReconstruction, StrayPointsMakeNoPiece)
{
  fusion::FusedCloud cloud = sphere();
  for (int i = 0; i < 5; ++i)
  {
    cloud.points.push_back({ 0.12f + 0.001f * i, 0, 0 });
    cloud.normals.push_back(Eigen::Vector3f::UnitX());
    cloud.colors.push_back({ 0, 0, 0 });
  }
  const SurfaceResult result = reconstruct(cloud);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  for (const Eigen::Vector3f& vertex : result.mesh.vertices)
    EXPECT_LT(vertex.norm(), RADIUS_M + 0.002f);
}

TEST(SurfaceReconstruction, SameCloudGivesTheSameMesh)
{
  const SurfaceResult a = reconstruct(sphere(0)), b = reconstruct(sphere(0));
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.colors, b.mesh.colors);
}

TEST(SurfaceReconstruction, ClosedSurfaceEndsOnTheSupportAndSaysWhatWasNotSeen)
{
  constexpr float FLOOR_M = -0.03f;
  SurfaceOptions options;
  options.watertight = true;
  geometry::Plane support;
  support.offset_m = -FLOOR_M;
  const SurfaceResult result = reconstruct(sphere(FLOOR_M), options, support);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const mesh::TriangleMesh& mesh = result.mesh;
  EXPECT_TRUE(mesh::checkMesh(mesh).watertight());
  const double cap_m = RADIUS_M + FLOOR_M;
  EXPECT_NEAR(mesh::checkMesh(mesh).volume_m3,
              M_PI * (4.0 / 3 * std::pow(RADIUS_M, 3) - cap_m * cap_m * (RADIUS_M - cap_m / 3)),
              0.02 * 4.0 / 3 * M_PI * std::pow(RADIUS_M, 3));
  ASSERT_EQ(mesh.seen.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    EXPECT_GT(mesh.vertices[i].z(), FLOOR_M - 0.003f);
    const bool above = mesh.vertices[i].z() > FLOOR_M + 0.005f;
    const bool below = mesh.vertices[i].z() < FLOOR_M + 0.001f && mesh.vertices[i].head<2>().norm() < 0.02f;
    EXPECT_TRUE(!above || mesh.seen[i] == 1) << mesh.vertices[i].transpose();
    EXPECT_TRUE(!below || mesh.seen[i] == 0) << mesh.vertices[i].transpose();
  }
  const SurfaceResult open = reconstruct(sphere(FLOOR_M));
  EXPECT_TRUE(mesh::checkMesh(open.mesh).manifold());
  EXPECT_FALSE(mesh::checkMesh(open.mesh).watertight());
  EXPECT_TRUE(open.mesh.seen.empty());
}

TEST(SurfaceReconstruction, KeepsWithinTheBudgetOfTriangles)
{
  SurfaceOptions options;
  options.max_triangles = 2000;
  const SurfaceResult result = reconstruct(sphere(), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.warning.empty()) << result.warning;
  EXPECT_LE(result.mesh.triangles.size(), 2000u);
  EXPECT_EQ(result.mesh.colors.size(), result.mesh.vertices.size());
  options.max_triangles = 20;
  EXPECT_NE(reconstruct(sphere(), options).warning.find("20"), std::string::npos);
}

TEST(SurfaceReconstruction, PointsInOnePlaceDoNotHarm)
{
  fusion::FusedCloud cloud;
  cloud.points.assign(200, Eigen::Vector3f(0.1f, 0.2f, 0.7f));
  cloud.normals.assign(200, Eigen::Vector3f::UnitZ());
  const SurfaceResult result = reconstruct(cloud);
  EXPECT_EQ(result.status.ok(), !result.mesh.empty()) << result.status.message;
}

TEST(SurfaceReconstruction, TooFewPointsAreNoSurface)
{
  fusion::FusedCloud few;
  few.points.assign(10, Eigen::Vector3f::Zero());
  few.normals.assign(10, Eigen::Vector3f::UnitZ());
  for (const fusion::FusedCloud& cloud : { fusion::FusedCloud(), few })
  {
    const SurfaceResult result = reconstruct(cloud);
    EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
    EXPECT_NE(result.status.message.find("points"), std::string::npos) << result.status.message;
  }
}

TEST(SurfaceReconstruction, StopsWhenCancelledAndRefusesBadOptions)
{
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(reconstructSurface(sphere(), std::nullopt, {}, control), base::Cancelled);
  SurfaceOptions options;
  options.resolution_m = std::numeric_limits<double>::quiet_NaN();
  options.max_support_distance_m = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "max_support_distance_m", "resolution_m" }));
  EXPECT_THROW(reconstruct(sphere(), options), base::Error);
}

}  // namespace
}  // namespace object_modelling::surface
