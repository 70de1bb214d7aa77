#include "object_modelling/object_properties/symmetry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solids.h"
#include "support/shapes.h"

namespace object_modelling::object_properties
{
namespace
{
using Of = Symmetry::Of;

std::vector<Symmetry> found(mesh::TriangleMesh mesh, Of of = Of::SHAPE)
{
  mesh::transform(awry(), &mesh);
  std::vector<Symmetry> result;
  for (Symmetry symmetry : findSymmetries(mesh))
    if (symmetry.of == of)
    {
      symmetry.axis = awry().linear().transpose() * symmetry.axis;
      symmetry.point_m = awry().inverse() * symmetry.point_m;
      result.push_back(symmetry);
    }
  return result;
}

std::size_t countOf(const std::vector<Symmetry>& symmetries, int order)
{
  return static_cast<std::size_t>(std::count_if(symmetries.begin(), symmetries.end(),
                                                [&](const Symmetry& symmetry) { return symmetry.order == order; }));
}

bool has(const std::vector<Symmetry>& symmetries, int order, const Eigen::Vector3d& axis, double max_deg = 1)
{
  return std::any_of(symmetries.begin(), symmetries.end(),
                     [&](const Symmetry& symmetry)
                     {
                       const Eigen::Vector3d off = symmetry.point_m - axis * axis.dot(symmetry.point_m);
                       return symmetry.order == order &&
                              std::abs(symmetry.axis.dot(axis)) > std::cos(max_deg * M_PI / 180) && off.norm() < 0.001;
                     });
}

std::string text(const std::vector<Symmetry>& symmetries)
{
  std::ostringstream out;
  for (const Symmetry& symmetry : symmetries)
    out << "order " << symmetry.order << " about " << symmetry.axis.transpose() << " error_mm "
        << 1000 * symmetry.error_m << "\n";
  return out.str();
}

void paintSide(const Eigen::Vector3f& outward, mesh::TriangleMesh* mesh)
{
  float furthest = 0;
  for (const Eigen::Vector3f& vertex : mesh->vertices)
    furthest = std::max(furthest, vertex.dot(outward));
  for (std::size_t i = 0; i < mesh->vertices.size(); ++i)
    if (mesh->vertices[i].dot(outward) > furthest - 1e-5f)
      mesh->colors[i] = { 200, 30, 30 };
}
}  // namespace

TEST(Symmetry, ABoxOfThreeEdgesTurnsByHalves)
{
  const std::vector<Symmetry> symmetries = found(box({ 0.2f, 0.13f, 0.06f }));
  EXPECT_EQ(symmetries.size(), 3u) << text(symmetries);
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(has(symmetries, 2, Eigen::Vector3d::Unit(i))) << text(symmetries);
}

TEST(Symmetry, ACubeHasThirteenAxes)
{
  const std::vector<Symmetry> symmetries = found(box({ 0.1f, 0.1f, 0.1f }));
  EXPECT_EQ(countOf(symmetries, 4), 3u) << text(symmetries);
  EXPECT_EQ(countOf(symmetries, 3), 4u) << text(symmetries);
  EXPECT_EQ(countOf(symmetries, 2), 6u) << text(symmetries);
  EXPECT_TRUE(has(symmetries, 4, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(has(symmetries, 3, Eigen::Vector3d::Ones().normalized()));
}

TEST(Symmetry, ASquareSlabTurnsByQuarters)
{
  const std::vector<Symmetry> symmetries = found(box({ 0.1f, 0.1f, 0.04f }));
  EXPECT_TRUE(has(symmetries, 4, Eigen::Vector3d::UnitZ())) << text(symmetries);
  EXPECT_EQ(countOf(symmetries, 2), 4u) << text(symmetries);
  EXPECT_EQ(symmetries.size(), 5u) << text(symmetries);
}

TEST(Symmetry, ACylinderIsRoundAndTurnsOver)
{
  const std::vector<Symmetry> symmetries = found(cylinder(0.033f, 0.1f));
  ASSERT_EQ(symmetries.size(), 2u) << text(symmetries);
  EXPECT_TRUE(has(symmetries, 0, Eigen::Vector3d::UnitZ())) << text(symmetries);
  EXPECT_TRUE(symmetries[0].continuous());
  EXPECT_EQ(symmetries[1].order, 2);
  EXPECT_NEAR(symmetries[1].axis.z(), 0, 0.02);
}

TEST(Symmetry, ABallIsRoundAboutTwoAxes)
{
  const std::vector<Symmetry> symmetries = found(ball(0.05f));
  ASSERT_EQ(symmetries.size(), 2u) << text(symmetries);
  EXPECT_TRUE(symmetries[0].continuous() && symmetries[1].continuous());
  EXPECT_LT(std::abs(symmetries[0].axis.dot(symmetries[1].axis)), 0.9);
}

TEST(Symmetry, AHandleTakesItAway)
{
  const std::vector<Symmetry> round = found(mug(false));
  ASSERT_EQ(round.size(), 1u) << text(round);
  EXPECT_TRUE(has(round, 0, Eigen::Vector3d::UnitZ())) << text(round);
  const std::vector<Symmetry> with_handle = found(mug());
  EXPECT_TRUE(with_handle.empty()) << text(with_handle);
  EXPECT_TRUE(found(test_support::lopsidedShape(12)).empty());
}

TEST(Symmetry, APrintOnOneSideTakesItAwayFromTheTexture)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.13f, 0.06f }, 24);
  paint({ 180, 180, 170 }, &mesh);
  EXPECT_EQ(found(mesh, Of::TEXTURE).size(), 3u);
  paintSide(Eigen::Vector3f::UnitZ(), &mesh);
  const std::vector<Symmetry> one_side = found(mesh, Of::TEXTURE);
  EXPECT_EQ(one_side.size(), 1u) << text(one_side);
  EXPECT_TRUE(has(one_side, 2, Eigen::Vector3d::UnitZ())) << text(one_side);
  paintSide(Eigen::Vector3f::UnitX(), &mesh);
  EXPECT_TRUE(found(mesh, Of::TEXTURE).empty());
  EXPECT_EQ(found(mesh).size(), 3u);
}

TEST(Symmetry, TheFrontOfACanCounts)
{
  mesh::TriangleMesh mesh = cylinder(0.033f, 0.1f, 128);
  paint({ 180, 180, 170 }, &mesh);
  EXPECT_EQ(found(mesh, Of::TEXTURE).size(), 2u);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (mesh.vertices[i].x() > 0.02f)
      mesh.colors[i] = { 20, 30, 150 };
  const std::vector<Symmetry> labelled = found(mesh, Of::TEXTURE);
  EXPECT_EQ(labelled.size(), 1u) << text(labelled);
  EXPECT_TRUE(has(labelled, 2, Eigen::Vector3d::UnitX(), 5)) << text(labelled);
}

TEST(Symmetry, WhatNobodySawDoesNotCount)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.13f, 0.06f }, 24);
  mesh.seen.assign(mesh.vertices.size(), 1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (mesh.vertices[i].z() < -0.0299f)
    {
      mesh.seen[i] = 0;
      mesh.vertices[i].z() += 0.3f * std::abs(mesh.vertices[i].x()) * mesh.vertices[i].y();
    }
  const std::vector<Symmetry> symmetries = found(mesh);
  EXPECT_TRUE(has(symmetries, 2, Eigen::Vector3d::UnitZ())) << text(symmetries);
}

TEST(Symmetry, OfALittleNothingIsClaimed)
{
  mesh::TriangleMesh mesh = box({ 0.2f, 0.13f, 0.06f }, 24);
  mesh.seen.assign(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (mesh.vertices[i].x() > 0.0999f)
      mesh.seen[i] = 1;
  EXPECT_TRUE(found(mesh).empty()) << text(found(mesh));
}

TEST(Symmetry, OfNothing)
{
  EXPECT_TRUE(findSymmetries({}).empty());
}

}  // namespace object_modelling::object_properties
