#include "object_modelling/mesh/reference_surface.h"

#include <limits>

#include <gtest/gtest.h>

#include "object_modelling/base/status.h"
#include "support/shapes.h"

namespace object_modelling::mesh
{
namespace
{
TEST(ReferenceSurfaceTest, FacesEdgesAndCorners)
{
  TriangleMesh box;
  test_support::addBox({ 0, 0, 0 }, { 0.1f, 0.2f, 0.3f }, 1, &box);
  const ReferenceSurface surface(box);
  EXPECT_NEAR((surface.closestPoint({ 0.05, 0.1, 0.4 }) - Eigen::Vector3d(0.05, 0.1, 0.3)).norm(), 0, 1e-7);
  EXPECT_NEAR(surface.distance_m({ -0.03, 0.1, -0.04 }), 0.05, 1e-7);                // edge
  EXPECT_NEAR(surface.distance_m({ 0.11, 0.21, 0.31 }), std::sqrt(3) * 0.01, 1e-7);  // corner
  EXPECT_NEAR(surface.distance_m({ 0.02, 0.1, 0.15 }), 0.02, 1e-7);                  // inside
  EXPECT_NEAR(surface.distance_m({ 5.1, 0.1, 0.15 }), 5, 1e-6);                      // far away
  EXPECT_NEAR(surface.diagonal_m(), std::sqrt(0.01 + 0.04 + 0.09), 1e-7);
}

TEST(ReferenceSurfaceTest, SamplesLieOnTheSurfaceAndAreEven)
{
  TriangleMesh box;
  test_support::addBox({ 0, 0, 0 }, { 0.1f, 0.1f, 0.1f }, 2, &box);
  test_support::addBox({ 1, 0, 0 }, { 0.1f, 0.1f, 0.1f }, 9, &box);
  const ReferenceSurface surface(box);
  std::size_t at_first = 0;
  for (const Eigen::Vector3d& sample : surface.samples())
  {
    EXPECT_LT(surface.distance_m(sample), 1e-7);
    at_first += sample.x() < 0.5;
  }
  EXPECT_NEAR(static_cast<double>(at_first) / static_cast<double>(surface.samples().size()), 0.5, 0.002);
}

TEST(ReferenceSurfaceTest, RefusesWhatHasNoSurface)
{
  TriangleMesh mesh;
  EXPECT_THROW(ReferenceSurface{ mesh }, base::Error);
  mesh.vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } };
  mesh.triangles = { { 0, 1, 2 } };
  EXPECT_THROW(ReferenceSurface{ mesh }, base::Error);
  mesh.vertices[2] = { 0, std::numeric_limits<float>::quiet_NaN(), 0 };
  EXPECT_THROW(ReferenceSurface{ mesh }, base::Error);
  mesh.vertices[2] = { 0, 1, 0 };
  EXPECT_NEAR(ReferenceSurface(mesh).distance_m({ 0.2, 0.2, 0.7 }), 0.7, 1e-7);
}

}  // namespace
}  // namespace object_modelling::mesh
