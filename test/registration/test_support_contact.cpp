#include "object_modelling/registration/support_contact.h"

#include <gtest/gtest.h>

#include "object_modelling/registration/pair_icp.h"

namespace object_modelling::registration
{
namespace
{
constexpr float RADIUS_M = 0.04F, HEIGHT_M = 0.06F, SPACING_M = 0.002F;

/// What is seen of a can that stands on z = 0: its side without the lowest 5 mm, and its lid.
PartialModel standingCan(bool with_plane)
{
  PartialModel can;
  can.spacing_m = SPACING_M;
  for (float z = 0.005F; z < HEIGHT_M - 0.005F; z += SPACING_M)
    for (float angle = 0; angle < 2 * static_cast<float>(M_PI); angle += SPACING_M / RADIUS_M)
    {
      can.normals.emplace_back(std::cos(angle), std::sin(angle), 0);
      can.points.push_back(RADIUS_M * can.normals.back() + z * Eigen::Vector3f::UnitZ());
    }
  for (float x = -RADIUS_M; x < RADIUS_M; x += SPACING_M)
    for (float y = -RADIUS_M; y < RADIUS_M; y += SPACING_M)
      if (std::hypot(x, y) < RADIUS_M - 0.004F)
      {
        can.normals.push_back(Eigen::Vector3f::UnitZ());
        can.points.emplace_back(x, y, HEIGHT_M);
      }
  can.colors.assign(can.points.size(), Eigen::Vector3f::Zero());
  if (with_plane)
    can.support_plane = geometry::Plane{ Eigen::Vector3d::UnitZ(), 0 };
  return can;
}

Eigen::Isometry3f upsideDown(float lifted_m)
{
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  T.linear() = Eigen::AngleAxisf(static_cast<float>(M_PI), Eigen::Vector3f::UnitX()).toRotationMatrix();
  T.translation().z() = HEIGHT_M + lifted_m;
  return T;
}

TEST(SupportContact, lowestPointIsThatOfThePartAsPlaced)
{
  const PartialModel can = standingCan(true);
  const MatchedSurface part(can, 1);
  const LowestPoint as_it_stands = lowestPoint(part, Eigen::Isometry3f::Identity(), *can.support_plane);
  EXPECT_NEAR(as_it_stands.height_m, 0.005, 1e-3);
  EXPECT_NEAR(as_it_stands.point.z(), 0.005, 1e-3);
  const LowestPoint turned = lowestPoint(part, upsideDown(0.003F), *can.support_plane);
  EXPECT_NEAR(turned.height_m, 0.003, 1e-5);
  EXPECT_NEAR(turned.point.z(), HEIGHT_M, 1e-5);
  EXPECT_NEAR(contactGap_m(part, part, upsideDown(-0.002F)), 0.002, 1e-5);
}

TEST(SupportContact, holdsACanAlongItsAxis)
{
  PairIcpOptions icp;
  icp.coarse = false;
  icp.gate_m = 0.005;
  icp.last_gate_m = 0.003;
  icp.iterations = 30;
  for (const bool with_plane : { true, false })
  {
    const PartialModel can = standingCan(with_plane);
    const MatchedSurface part(can, 1);
    const Eigen::Isometry3f T = alignByIcp(part, part, upsideDown(0.004F), icp);
    EXPECT_NEAR(T.translation().z(), HEIGHT_M + (with_plane ? 0 : 0.004F), 5e-4) << with_plane;
    EXPECT_LT(T.translation().head<2>().norm(), 5e-4);
  }
}

TEST(SupportContact, doesNotBendWhatSurfacesHold)
{
  // As if the table had been found 3 mm too low: the lids meet, and they weigh more.
  PartialModel can = standingCan(true);
  can.support_plane->offset_m = 0.003;
  const MatchedSurface part(can, 1);
  PairIcpOptions icp;
  icp.coarse = false;
  icp.gate_m = 0.005;
  icp.last_gate_m = 0.003;
  const Eigen::Isometry3f T = alignByIcp(part, part, Eigen::Isometry3f::Identity(), icp);
  EXPECT_LT(T.translation().norm(), 2e-4);
}
}  // namespace
}  // namespace object_modelling::registration
