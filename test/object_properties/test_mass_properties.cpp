#include "object_modelling/object_properties/mass_properties.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solids.h"
#include "support/thrown_status.h"

namespace object_modelling::object_properties
{
namespace
{
/// About the centre of mass.
Eigen::Matrix3d boxInertia(const Eigen::Vector3d& size_m)
{
  const Eigen::Vector3d squares = size_m.cwiseAbs2();
  const Eigen::Vector3d diagonal(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y());
  return (size_m.prod() / 12 * diagonal).asDiagonal();
}
}  // namespace

TEST(MassProperties, OfABoxSomewhere)
{
  const Eigen::Vector3d size_m(0.2, 0.1, 0.06);
  mesh::TriangleMesh mesh = box(size_m.cast<float>());
  mesh::transform(awry(), &mesh);
  const MassProperties mass = massProperties(mesh);
  EXPECT_TRUE(mass.closed);
  EXPECT_EQ(mass.of, Solid::MESH);
  EXPECT_NEAR(mass.volume_m3, 0.0012, 1e-8);
  EXPECT_LT((mass.center_of_mass_m - awry().translation()).norm(), 1e-6);
  const Eigen::Matrix3d expected = awry().linear() * boxInertia(size_m) * awry().linear().transpose();
  EXPECT_LT((mass.inertia_per_density_m5 - expected).norm(), 1e-5 * expected.norm());
  EXPECT_NEAR(mass.mass_kg, 0.6, 1e-5);
}

TEST(MassProperties, OfACylinder)
{
  const double r = 0.03, h = 0.12;
  const MassProperties mass = massProperties(cylinder(0.03f, 0.12f, 512));
  EXPECT_NEAR(mass.volume_m3, M_PI * r * r * h, 1e-4 * mass.volume_m3);
  EXPECT_NEAR(mass.inertia_per_density_m5(2, 2), mass.volume_m3 * r * r / 2, 1e-4 * mass.inertia_per_density_m5(2, 2));
  EXPECT_NEAR(mass.inertia_per_density_m5(0, 0), mass.volume_m3 * (3 * r * r + h * h) / 12,
              1e-4 * mass.inertia_per_density_m5(0, 0));
}

TEST(MassProperties, AMissingSideIsClosedFlat)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.1f, 0.06f });
  const auto at_bottom = [&](const std::array<std::uint32_t, 3>& triangle)
  {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](std::uint32_t vertex) { return mesh.vertices[vertex].z() < -0.0299f; });
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), at_bottom), mesh.triangles.end());
  const MassProperties mass = massProperties(mesh);
  EXPECT_FALSE(mass.closed);
  EXPECT_EQ(mass.of, Solid::CLOSED_MESH);
  EXPECT_NEAR(mass.volume_m3, 0.0012, 1e-8);
  EXPECT_LT(mass.center_of_mass_m.norm(), 1e-6);
}

TEST(MassProperties, InsideOutOrDoubledIsTakenForItsHull)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.1f, 0.06f }, 2);
  mesh::TriangleMesh doubled = mesh;
  doubled.triangles.insert(doubled.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  for (auto& triangle : mesh.triangles)
    std::swap(triangle[0], triangle[1]);
  for (const mesh::TriangleMesh& wrong : { mesh, doubled })
  {
    const MassProperties mass = massProperties(wrong);
    EXPECT_EQ(mass.of, Solid::HULL);
    EXPECT_NEAR(mass.volume_m3, 0.0012, 1e-8);
  }
}

TEST(MassProperties, SeamsAreNoBordersAndAMugIsHollow)
{
  const MassProperties mass = massProperties(mug(false));
  EXPECT_TRUE(mass.closed);
  const double expected = M_PI * (0.04 * 0.04 * 0.1 - 0.036 * 0.036 * 0.096);
  EXPECT_NEAR(mass.volume_m3, expected, 0.01 * expected);
}

TEST(MassProperties, AWeighedMassGivesTheDensity)
{
  MassOptions options;
  options.mass_kg = 0.9;
  const MassProperties mass = massProperties(box({ 0.2f, 0.1f, 0.06f }), options);
  EXPECT_DOUBLE_EQ(mass.mass_kg, 0.9);
  EXPECT_NEAR(mass.density_kg_m3, 750, 0.01);
}

TEST(MassProperties, OfNothing)
{
  EXPECT_EQ(massProperties({}).volume_m3, 0);
  MassOptions broken;
  broken.density_kg_m3 = 0;
  EXPECT_EQ(test_support::statusOf([&] { massProperties(ball(0.1f), broken); }).code,
            base::StatusCode::INVALID_ARGUMENT);
}

}  // namespace object_modelling::object_properties
