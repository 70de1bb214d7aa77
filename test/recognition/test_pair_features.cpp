#include "object_modelling/recognition/pair_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace object_modelling::recognition
{
namespace
{
/// A box without the two sides at -x and -y and with a block on top: no two poses of it look alike.
OrientedPoints surface()
{
  OrientedPoints result;
  const auto add = [&](float x, float y, float z, const Eigen::Vector3f& n)
  {
    result.points.emplace_back(x, y, z);
    result.normals.push_back(n);
  };
  for (float a = 0; a < 0.1F; a += 0.002F)
    for (float b = 0; b < 0.06F; b += 0.002F)
    {
      add(a, b, 0.04F, Eigen::Vector3f::UnitZ());
      if (b < 0.04F)
        add(a, 0.06F, b, Eigen::Vector3f::UnitY());
      if (a < 0.06F && b < 0.04F)
        add(0.1F, a, b, Eigen::Vector3f::UnitX());
      if (a < 0.03F && b < 0.03F)
        add(a, b, 0.07F, Eigen::Vector3f::UnitZ());
      if (a < 0.03F && b < 0.03F)
        add(0.03F, a, 0.04F + b, Eigen::Vector3f::UnitX());
    }
  return result;
}

constexpr double DIAMETER_M = 0.137;

TEST(PairFeatures, ThinnedKeepsOnePointPerCubeAndDirection)
{
  const OrientedPoints thin = thinned(surface(), 0.01);
  EXPECT_LT(thin.size(), surface().size() / 8);
  EXPECT_GT(thin.size(), 100U);
  for (const Eigen::Vector3f& normal : thin.normals)
    EXPECT_NEAR(normal.norm(), 1, 1e-5);
}

TEST(PairFeatures, ThinnedKeepsBothSidesOfAThinThing)
{
  OrientedPoints plate;
  for (const float side : { -1.F, 1.F })
  {
    plate.points.emplace_back(0.001F, 0.001F, 0.001F + 0.0005F * side);
    plate.normals.push_back(side * Eigen::Vector3f::UnitZ());
  }
  EXPECT_EQ(thinned(plate, 0.01).size(), 2U);
}

TEST(PairFeatures, VotesForThePoseOfTheScene)
{
  const PairTable table(surface(), DIAMETER_M);
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  T.rotate(Eigen::AngleAxisf(2.1F, Eigen::Vector3f(1, -2, 0.5F).normalized()))
      .pretranslate(Eigen::Vector3f(0.2F, -0.1F, 0.9F));
  OrientedPoints moved = surface();
  for (std::size_t i = 0; i < moved.size(); ++i)
  {
    moved.points[i] = T * moved.points[i];
    moved.normals[i] = T.linear() * moved.normals[i];
  }
  const OrientedPoints scene = thinned(moved, table.spacing_m());
  std::vector<VotedPose> poses;
  std::vector<float> accumulator;
  for (std::size_t i = 0; i < scene.size(); i += 5)
    table.vote(scene, i, &accumulator, &poses);
  const Eigen::Vector3f centre(0.05F, 0.03F, 0.03F);
  poses = clustered(poses, centre, 0.0137F, 0.35F);
  ASSERT_FALSE(poses.empty());
  const Eigen::Isometry3f off = T.inverse() * poses.front().T_scene_model;
  EXPECT_LT((poses.front().T_scene_model * centre - T * centre).norm(), 0.012F);
  EXPECT_LT(Eigen::AngleAxisf(off.linear()).angle(), 0.3F);
}

TEST(PairFeatures, ClusteredAddsVotesOfOnePlace)
{
  VotedPose a, b, c;
  a.votes = 3;
  b.votes = 2;
  b.T_scene_model.translation().x() = 0.004F;
  c.votes = 4;
  c.T_scene_model.translation().x() = 0.5F;
  const std::vector<VotedPose> poses = clustered({ a, b, c }, Eigen::Vector3f::Zero(), 0.01F, 0.3F);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_FLOAT_EQ(poses[0].votes, 5);
  EXPECT_FLOAT_EQ(poses[1].votes, 4);
}

TEST(PairFeatures, NothingVotesForAnEmptyScene)
{
  const PairTable table(surface(), DIAMETER_M);
  OrientedPoints one;
  one.points.emplace_back(0, 0, 1);
  one.normals.emplace_back(0, 0, -1);
  std::vector<VotedPose> poses;
  std::vector<float> accumulator;
  table.vote(one, 0, &accumulator, &poses);
  EXPECT_TRUE(poses.empty());
}

}  // namespace
}  // namespace object_modelling::recognition
