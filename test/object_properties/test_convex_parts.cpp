#include "object_modelling/object_properties/convex_parts.h"

#include <gtest/gtest.h>

#include "object_modelling/geometry/convex_hull.h"
#include "object_modelling/mesh/mesh_check.h"
#include "solids.h"
#include "support/shapes.h"

namespace object_modelling::object_properties
{
namespace
{
/// How far outside of every part a point is, m; negative inside of one.
float outside_m(const std::vector<mesh::TriangleMesh>& parts, const Eigen::Vector3f& p)
{
  float nearest = 1e9f;
  for (const mesh::TriangleMesh& part : parts)
  {
    float furthest = -1e9f;
    for (const auto& [a, b, c] : part.triangles)
    {
      const Eigen::Vector3f origin = part.vertices[a];
      const Eigen::Vector3f normal = (part.vertices[b] - origin).cross(part.vertices[c] - origin).normalized();
      furthest = std::max(furthest, normal.dot(p - origin));
    }
    nearest = std::min(nearest, furthest);
  }
  return nearest;
}

void expectSound(const mesh::TriangleMesh& mesh, const std::vector<mesh::TriangleMesh>& parts)
{
  EXPECT_LE(parts.size(), 16u);
  for (const mesh::TriangleMesh& part : parts)
  {
    EXPECT_TRUE(mesh::checkMesh(part).watertight());
    EXPECT_LE(part.vertices.size(), 64u);
    EXPECT_NEAR(mesh::checkMesh(part).volume_m3, geometry::hullSurface(part.vertices).volume_m3(), 1e-9);
  }
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    EXPECT_LT(outside_m(parts, vertex), 0.001f) << vertex.transpose();
}
}  // namespace

TEST(ConvexParts, WhatIsConvexIsOne)
{
  for (mesh::TriangleMesh mesh : { box({ 0.2f, 0.1f, 0.06f }), cylinder(0.03f, 0.1f, 32) })
  {
    mesh::transform(awry(), &mesh);
    const std::vector<mesh::TriangleMesh> parts = convexParts(mesh);
    ASSERT_EQ(parts.size(), 1u);
    expectSound(mesh, parts);
  }
  EXPECT_EQ(convexParts(ball(0.04f)).size(), 1u);
}

TEST(ConvexParts, AMugKeepsItsHollowAndItsHandle)
{
  const mesh::TriangleMesh mesh = mug();
  const std::vector<mesh::TriangleMesh> parts = convexParts(mesh);
  EXPECT_GT(parts.size(), 3u);
  expectSound(mesh, parts);
  EXPECT_GT(outside_m(parts, { 0, 0, 0 }), 0.015f);
  EXPECT_GT(outside_m(parts, { 0, 0, 0.04f }), 0.015f);
  EXPECT_GT(outside_m(parts, { 0.05f, 0, 0 }), 0.0f) << "between cup and handle";
}

TEST(ConvexParts, TwoBoxesAreTwo)
{
  const mesh::TriangleMesh mesh = test_support::lopsidedShape(4);
  const std::vector<mesh::TriangleMesh> parts = convexParts(mesh);
  EXPECT_GE(parts.size(), 2u);
  EXPECT_LE(parts.size(), 4u);
  expectSound(mesh, parts);
  EXPECT_GT(outside_m(parts, { 0.14f, 0.02f, 0.02f }), 0.015f);
}

TEST(ConvexParts, AsFewAsAskedFor)
{
  ConvexPartsOptions options;
  options.max_parts = 2;
  options.max_vertices = 12;
  const std::vector<mesh::TriangleMesh> parts = convexParts(mug(), options);
  EXPECT_LE(parts.size(), 2u);
  for (const mesh::TriangleMesh& part : parts)
    EXPECT_LE(part.vertices.size(), 12u);
}

TEST(ConvexParts, OfNothing)
{
  EXPECT_TRUE(convexParts({}).empty());
}

}  // namespace object_modelling::object_properties
