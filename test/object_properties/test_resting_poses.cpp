#include "object_modelling/object_properties/resting_poses.h"

#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/object_properties/mass_properties.h"
#include "solids.h"

namespace object_modelling::object_properties
{
namespace
{
std::vector<RestingPose> posesOf(const mesh::TriangleMesh& mesh, const std::vector<Eigen::Isometry3d>& recorded = {})
{
  return restingPoses(mesh.vertices, massProperties(mesh).center_of_mass_m, recorded);
}

double sum(const std::vector<RestingPose>& poses)
{
  double total = 0;
  for (const RestingPose& pose : poses)
    total += pose.probability;
  return total;
}

Eigen::Vector3d upOf(const RestingPose& pose)
{
  return pose.T_support_model.linear().row(2).transpose();
}

/// Lowest and highest point above the support.
std::pair<float, float> heights_m(const mesh::TriangleMesh& mesh, const RestingPose& pose)
{
  std::pair<float, float> range{ 1e9f, -1e9f };
  for (const Eigen::Vector3f& vertex : mesh.vertices)
  {
    const float z = (pose.T_support_model.cast<float>() * vertex).z();
    range = { std::min(range.first, z), std::max(range.second, z) };
  }
  return range;
}
}  // namespace

TEST(RestingPoses, ABoxLiesOnSixFacesTheLargestFirst)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.1f, 0.06f });
  mesh::transform(awry(), &mesh);
  const std::vector<RestingPose> poses = posesOf(mesh);
  ASSERT_EQ(poses.size(), 6u);
  EXPECT_NEAR(sum(poses), 1, 1e-9);
  // Solid angle of a rectangle seen from above its middle.
  const double a = 0.1, b = 0.05, d = 0.03;
  const double share = std::atan(a * b / (d * std::sqrt(a * a + b * b + d * d))) / M_PI;
  EXPECT_NEAR(poses[0].probability, share, 1e-4);
  EXPECT_NEAR(poses[1].probability, share, 1e-4);
  for (const RestingPose& pose : poses)
  {
    EXPECT_FALSE(pose.seen);
    EXPECT_NEAR(heights_m(mesh, pose).first, 0, 1e-6);
  }
  EXPECT_NEAR(heights_m(mesh, poses[0]).second, 0.06, 1e-6);
  EXPECT_NEAR(heights_m(mesh, poses[5]).second, 0.2, 1e-6);
}

TEST(RestingPoses, ACubeHasSixAlike)
{
  const std::vector<RestingPose> poses = posesOf(box({ 0.1f, 0.1f, 0.1f }));
  ASSERT_EQ(poses.size(), 6u);
  for (const RestingPose& pose : poses)
    EXPECT_NEAR(pose.probability, 1.0 / 6, 1e-4);
}

TEST(RestingPoses, ACanStandsOrLies)
{
  const std::vector<RestingPose> poses = posesOf(cylinder(0.03f, 0.12f, 200));
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_NEAR(upOf(poses[0]).z(), 0, 0.02);  // on its side, whatever the roll
  const double cap = (1 - 0.06 / std::hypot(0.06, 0.03)) / 2;
  EXPECT_NEAR(poses[1].probability, cap, 1e-3);
  EXPECT_NEAR(poses[2].probability, cap, 1e-3);
}

TEST(RestingPoses, ABallHasOne)
{
  const std::vector<RestingPose> poses = posesOf(ball(0.05f));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_DOUBLE_EQ(poses[0].probability, 1);
}

TEST(RestingPoses, ATallSlantedPrismFallsOver)
{
  mesh::TriangleMesh mesh = box({ 0.05f, 0.05f, 0.2f });
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex.x() += 0.8f * vertex.z();  // the centre of mass is beyond the edge of either end
  const std::vector<RestingPose> poses = posesOf(mesh);
  ASSERT_FALSE(poses.empty());
  EXPECT_NEAR(sum(poses), 1, 1e-9);
  for (const RestingPose& pose : poses)
    EXPECT_LT(std::abs(upOf(pose).z()), 0.9) << "stands on its end";
}

TEST(RestingPoses, RecordedOnesAreMatchedWhateverTheirTurn)
{
  const mesh::TriangleMesh mesh = box({ 0.2f, 0.1f, 0.06f });
  Eigen::Isometry3d lying = Eigen::Isometry3d::Identity(), tilted = lying;
  lying.linear() = (Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()))
                       .toRotationMatrix();
  lying.translation().z() = 0.03;
  tilted.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const std::vector<RestingPose> poses = posesOf(mesh, { lying, tilted });
  ASSERT_EQ(poses.size(), 7u);
  EXPECT_NEAR(sum(poses), 1, 1e-9);
  int seen = 0;
  for (const RestingPose& pose : poses)
  {
    seen += pose.seen ? 1 : 0;
    if (pose.seen && pose.probability > 0)
    {
      EXPECT_TRUE(pose.T_support_model.isApprox(lying));
    }
  }
  EXPECT_EQ(seen, 2);
  EXPECT_TRUE(poses.back().T_support_model.isApprox(tilted));
  EXPECT_EQ(poses.back().probability, 0);
}

TEST(RestingPoses, OfAFlatThingTheRecordedOnes)
{
  const std::vector<Eigen::Vector3f> flat{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } };
  EXPECT_TRUE(restingPoses(flat, Eigen::Vector3d::Zero(), {}).empty());
  const std::vector<RestingPose> poses = restingPoses(flat, Eigen::Vector3d::Zero(), { Eigen::Isometry3d::Identity() });
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_DOUBLE_EQ(poses[0].probability, 1);
}

}  // namespace object_modelling::object_properties
