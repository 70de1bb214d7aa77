#include "object_modelling/object_properties/object_properties.h"

#include <gtest/gtest.h>

#include "solids.h"

namespace object_modelling::object_properties
{
namespace
{
void hide(const std::function<bool(const Eigen::Vector3f&)>& unseen, mesh::TriangleMesh* mesh)
{
  mesh->seen.assign(mesh->vertices.size(), 1);
  for (std::size_t i = 0; i < mesh->vertices.size(); ++i)
    mesh->seen[i] = unseen(mesh->vertices[i]) ? 0 : 1;
}

Eigen::Isometry3d standing(double height_m)
{
  return Eigen::Isometry3d(Eigen::Translation3d(0, 0, height_m));
}
}  // namespace

TEST(ObjectProperties, OfABoxInOneGo)
{
  const mesh::TriangleMesh mesh = box({ 0.2f, 0.1f, 0.06f });
  base::JobControl control;
  const ObjectProperties properties = propertiesOf(mesh, { standing(0.03) }, {}, control);
  EXPECT_NEAR(properties.mass.volume_m3, 0.0012, 1e-8);
  EXPECT_EQ(properties.resting_poses.size(), 6u);
  EXPECT_EQ(properties.symmetries.size(), 3u);
  EXPECT_EQ(properties.collision_parts.size(), 1u);
  EXPECT_FALSE(properties.unseen);
  const std::string text = summaryText(properties, properties.collision_parts.size());
  EXPECT_NE(text.find("volume 1200 ml"), std::string::npos) << text;
  EXPECT_NE(text.find("2-fold, 2-fold, 2-fold"), std::string::npos) << text;
  EXPECT_NE(text.find("(1 recorded)"), std::string::npos) << text;
}

TEST(ObjectProperties, ABottomThatNobodySaw)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.1f, 0.06f }, 20);
  hide([](const Eigen::Vector3f& p) { return p.z() < -0.0299f; }, &mesh);
  const Unseen below = unseenOf(mesh, standing(0.03));
  EXPECT_TRUE(below.bottom);
  EXPECT_NEAR(below.ratio, 0.02 / 0.076, 0.05);
  hide([](const Eigen::Vector3f& p) { return p.z() > 0.0299f; }, &mesh);
  EXPECT_FALSE(unseenOf(mesh, standing(0.03)).bottom);
  mesh.seen.assign(mesh.seen.size(), 1);
  EXPECT_EQ(unseenOf(mesh, standing(0.03)).ratio, 0);
}

TEST(ObjectProperties, AnOpenBottomIsNoShareOfTheMesh)
{
  ObjectProperties properties;
  properties.unseen = Unseen{ 0.002, true };
  EXPECT_NE(summaryText(properties, 1).find("0 % of the mesh unseen; the bottom was not seen, and may be open"),
            std::string::npos);
  properties.mass.closed = true;
  EXPECT_NE(summaryText(properties, 1).find("the bottom was not seen"), std::string::npos);
  EXPECT_EQ(summaryText(properties, 1).find("open"), std::string::npos);
  properties.unseen->bottom = false;
  EXPECT_EQ(summaryText(properties, 1).find("bottom"), std::string::npos);
}

TEST(ObjectProperties, AMissingBottomIsNotSeenEither)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.1f, 0.06f }, 20);
  mesh.seen.assign(mesh.vertices.size(), 1);
  const auto at_bottom = [&](const std::array<std::uint32_t, 3>& triangle)
  {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](std::uint32_t vertex) { return mesh.vertices[vertex].z() < -0.0299f; });
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), at_bottom), mesh.triangles.end());
  EXPECT_TRUE(unseenOf(mesh, standing(0.03)).bottom);
}

TEST(ObjectProperties, CanBeCancelled)
{
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(propertiesOf(ball(0.04f), {}, {}, control), base::Cancelled);
}

}  // namespace object_modelling::object_properties
