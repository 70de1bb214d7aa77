#include "object_modelling/evaluation/registration.h"

#include <random>

#include <gtest/gtest.h>

#include "support/shapes.h"
#include "support/transform_matchers.h"
#include "support/violations.h"

namespace object_modelling::evaluation
{
namespace
{
using test_support::farAway;
using test_support::lopsidedShape;
using test_support::moved;
using test_support::pointsOf;

RegistrationResult registered(const std::vector<Eigen::Vector3d>& points, const mesh::ReferenceSurface& surface,
                              const std::optional<Eigen::Isometry3d>& T_start = std::nullopt,
                              const RegistrationOptions& options = {})
{
  base::JobControl control;
  return registerToSurface(points, surface, T_start, options, control);
}

TEST(RegistrationTest, FindsAKnownDisplacementWithoutAGuess)
{
  const mesh::ReferenceSurface surface(lopsidedShape(4));
  const Eigen::Isometry3d T_model_reference = farAway();
  const RegistrationResult result = registered(moved(T_model_reference, pointsOf(lopsidedShape(23))), surface);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.converged);
  EXPECT_TRANSFORM_NEAR(result.T_reference_model, T_model_reference.inverse(), 1e-6, 1e-5);
}

TEST(RegistrationTest, FindsEveryOfManyTurns)
{
  const mesh::ReferenceSurface surface(lopsidedShape(4));
  const std::vector<Eigen::Vector3d> points = pointsOf(lopsidedShape(13));
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 4; ++i)
  {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                     .normalized()
                     .toRotationMatrix();
    T.translation() = Eigen::Vector3d(normal(random), normal(random), normal(random));
    EXPECT_TRANSFORM_NEAR(registered(moved(T, points), surface).T_reference_model, T.inverse(), 1e-6, 1e-5) << i;
  }
}

TEST(RegistrationTest, NoiseStrayPointsAndAMissingBottomDoNotMatter)
{
  const mesh::ReferenceSurface surface(lopsidedShape(4));
  std::mt19937 random(5);
  std::normal_distribution<double> noise_m(0, 0.0005);
  std::uniform_real_distribution<double> anywhere_m(-0.05, 0.25);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& point : pointsOf(lopsidedShape(31)))
    if (point.z() > 0.02)
      points.push_back(point + Eigen::Vector3d(noise_m(random), noise_m(random), noise_m(random)));
  const std::size_t stray = points.size() / 20;
  for (std::size_t i = 0; i < stray; ++i)
    points.emplace_back(anywhere_m(random), anywhere_m(random), anywhere_m(random));
  const RegistrationResult result = registered(moved(farAway(), points), surface);
  ASSERT_TRUE(result.status.ok());
  EXPECT_TRANSFORM_NEAR(result.T_reference_model, farAway().inverse(), 2e-4, 2e-3);
}

TEST(RegistrationTest, ASymmetricShapeLandsInOneOfItsPoses)
{
  mesh::TriangleMesh box, fine;
  test_support::addBox({ 0, 0, 0 }, { 0.06f, 0.16f, 0.2f }, 2, &box);
  test_support::addBox({ 0, 0, 0 }, { 0.06f, 0.16f, 0.2f }, 20, &fine);
  const mesh::ReferenceSurface surface(box);
  const std::vector<Eigen::Vector3d> points = moved(farAway(), pointsOf(fine));
  const RegistrationResult result = registered(points, surface);
  for (const Eigen::Vector3d& point : points)
    EXPECT_LT(surface.distance_m(result.T_reference_model * point), 1e-5);
}

TEST(RegistrationTest, StartsFromAGuess)
{
  const mesh::ReferenceSurface surface(lopsidedShape(4));
  Eigen::Isometry3d T_near = farAway().inverse() * Eigen::Translation3d(0.003, -0.002, 0.004) *
                             Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitY());
  const RegistrationResult result = registered(moved(farAway(), pointsOf(lopsidedShape(23))), surface, T_near);
  EXPECT_TRANSFORM_NEAR(result.T_reference_model, farAway().inverse(), 1e-6, 1e-5);
}

TEST(RegistrationTest, TheSameEveryTime)
{
  const mesh::ReferenceSurface surface(lopsidedShape(4));
  const std::vector<Eigen::Vector3d> points = moved(farAway(), pointsOf(lopsidedShape(11)));
  EXPECT_EQ(registered(points, surface).T_reference_model.matrix(),
            registered(points, surface).T_reference_model.matrix());
}

TEST(RegistrationTest, SaysWhatFixesNoPose)
{
  mesh::TriangleMesh triangle;
  triangle.vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  triangle.triangles = { { 0, 1, 2 } };
  const mesh::ReferenceSurface one(triangle), surface(lopsidedShape(4));
  const std::vector<Eigen::Vector3d> points = pointsOf(lopsidedShape(3));
  EXPECT_EQ(registered(points, one).status.code, base::StatusCode::NO_RESULT);
  const std::vector<Eigen::Vector3d> few(points.begin(), points.begin() + 19);
  EXPECT_NE(registered(few, surface).status.message.find("19 points"), std::string::npos);
  // Points that all coincide: whatever comes of it, no numbers that are none.
  const RegistrationResult heap = registered(std::vector<Eigen::Vector3d>(50, Eigen::Vector3d(1, 1, 1)), surface);
  EXPECT_TRUE(heap.T_reference_model.matrix().allFinite());
}

TEST(RegistrationTest, CanBeCancelledAndChecksItsOptions)
{
  const mesh::ReferenceSurface surface(lopsidedShape(4));
  const std::vector<Eigen::Vector3d> points = pointsOf(lopsidedShape(5));
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(registerToSurface(points, surface, std::nullopt, {}, control), base::Cancelled);
  RegistrationOptions options;
  options.overlap_ratio = 0;
  options.start_count = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()), (std::vector<std::string>{ "overlap_ratio", "start_count" }));
  EXPECT_THROW(registered(points, surface, std::nullopt, options), base::Error);
}

}  // namespace
}  // namespace object_modelling::evaluation
