#include "object_modelling/geometry/transform.h"
#include "object_modelling/registration/pair_icp.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "made_part.h"
#include "object_modelling/registration/pair_refinement.h"

namespace object_modelling::registration
{
namespace
{
constexpr double DEGREE_RAD = M_PI / 180, MM_M = 1e-3;

Eigen::Vector3f texture(const Eigen::Vector3f& p)
{
  return { 0.3F * std::sin(160 * p.x() + 90 * p.y()), 0.3F * std::sin(140 * p.y() - 80 * p.z()),
           0.2F * std::sin(150 * p.z() + 70 * p.x()) };
}

/// Sides of a box of 60 x 80 x 100 mm about the origin that one session sees; `shift_m` moves the grid of points.
PartialModel boxSides(bool upper, float shift_m, unsigned seed)
{
  constexpr float WIDTH_M = 0.06F, DEPTH_M = 0.08F, HEIGHT_M = 0.1F;
  constexpr int ACROSS = 30, ALONG = 40, UP = 50;
  PartialModel part = madePart();
  const Eigen::Vector3f low = -0.5F * Eigen::Vector3f(WIDTH_M, DEPTH_M, HEIGHT_M), high = -low;
  const auto from = [&](float x, float y, float z, const Eigen::Vector3f& u, const Eigen::Vector3f& v)
  { return Eigen::Vector3f(Eigen::Vector3f(x, y, z) + shift_m * (u + v)); };
  addPatch(from(high.x(), low.y(), low.z(), Y, Z), Y, Z, ALONG, UP, texture, &part);
  addPatch(from(low.x(), high.y(), low.z(), Z, X), Z, X, UP, ACROSS, texture, &part);
  if (upper)
  {
    addPatch(from(low.x(), low.y(), high.z(), X, Y), X, Y, ACROSS, ALONG, texture, &part);
    addPatch(from(low.x(), low.y(), low.z(), Z, Y), Z, Y, UP, ALONG, texture, &part);
  }
  else
  {
    addPatch(from(low.x(), low.y(), low.z(), Y, X), Y, X, ALONG, ACROSS, texture, &part);
    addPatch(from(low.x(), low.y(), low.z(), X, Z), X, Z, ACROSS, UP, texture, &part);
  }
  // Of a fused cloud.
  std::mt19937 random(seed);
  std::normal_distribution<float> noise_m(0, 2e-4F), noise_color(0, 0.02F);
  for (std::size_t i = 0; i < part.points.size(); ++i)
  {
    part.points[i] += noise_m(random) * part.normals[i];
    part.colors[i] += Eigen::Vector3f(noise_color(random), noise_color(random), noise_color(random));
  }
  return part;
}

/// Off by some distance at the box, and by some angle about its centre, either in a random direction.
Eigen::Isometry3f disturbed(const Eigen::Isometry3f& T_a_b, const Eigen::Vector3f& center_b, double distance_m,
                            double angle_rad, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, 1);
  const auto direction = [&] { return Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized(); };
  const Eigen::Vector3f step = static_cast<float>(distance_m) * direction();
  return T_a_b * Eigen::Translation3f(center_b + step) * Eigen::AngleAxisf(static_cast<float>(angle_rad), direction()) *
         Eigen::Translation3f(-center_b);
}

double angle_deg(const Eigen::Isometry3f& T)
{
  return geometry::rotationAngle_rad(T.cast<double>()) / DEGREE_RAD;
}

/// Of two poses of one part: how far its centre is off, and by which angle.
void expectNear(const Eigen::Isometry3f& found, const Eigen::Isometry3f& truth, const Eigen::Vector3f& center_m,
                double distance_mm, double degrees, const std::string& what)
{
  EXPECT_LT((found * center_m - truth * center_m).norm() / MM_M, distance_mm) << what;
  EXPECT_LT(angle_deg(truth.inverse() * found), degrees) << what;
}

class PairIcp : public testing::Test
{
protected:
  // Both far from the origins of their frames, as objects are from cameras.
  const Eigen::Isometry3f T_a_box_ = pose({ 0.1F, -0.2F, 0.8F }, 0.7F, { 1, 2, 3 });
  const Eigen::Isometry3f T_b_box_ = pose({ -0.3F, 0.1F, 0.6F }, 2.3F, { -2, 1, 1 });
  const Eigen::Isometry3f T_a_b_ = T_a_box_ * T_b_box_.inverse();
  const PartialModel model_a_ = placed(boxSides(true, 0, 1), T_a_box_);
  const PartialModel model_b_ = placed(boxSides(false, 0.0007F, 2), T_b_box_);
  const MatchedSurface a_{ model_a_, 1 }, b_{ model_b_, 1 };
  const Eigen::Vector3f center_a_ = T_a_box_.translation(), center_b_ = T_b_box_.translation();
};

TEST_F(PairIcp, RefinesFromManyStartsEitherWay)
{
  const PartPair ab(a_, b_, 1), ba(b_, a_, 1);
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    const Eigen::Isometry3f start = disturbed(T_a_b_, center_b_, 4 * MM_M, 3 * DEGREE_RAD, seed);
    Eigen::Isometry3f T_a_b = start, T_b_a = start.inverse();
    const PairQuality quality = refinePairPose(ab, &T_a_b), inverse_quality = refinePairPose(ba, &T_b_a);
    const std::string what = "start " + std::to_string(seed);
    expectNear(T_a_b, T_a_b_, center_b_, 0.15, 0.15, what);
    expectNear(T_b_a, T_a_b_.inverse(), center_a_, 0.15, 0.15, what + ", a on b");
    expectNear(T_b_a.inverse(), T_a_b, center_b_, 0.02, 0.02, what + ", there and back");
    EXPECT_LT(quality.rmse_m, 0.5 * MM_M) << what;
    EXPECT_GT(quality.color_agreement, 0.95) << what;
    EXPECT_NEAR(inverse_quality.rmse_m, quality.rmse_m, 0.01 * MM_M) << what;
  }
}

TEST_F(PairIcp, StaysWhereItIsRight)
{
  const PartPair pair(a_, b_, 1);
  Eigen::Isometry3f T_a_b = T_a_b_;
  refinePairPose(pair, &T_a_b);
  expectNear(T_a_b, T_a_b_, center_b_, 0.15, 0.15, "from the truth");
  const Eigen::Isometry3f once = T_a_b;
  refinePairPose(pair, &T_a_b);
  expectNear(T_a_b, once, center_b_, 0.01, 0.01, "again");
}

TEST_F(PairIcp, ReachesFarByFewPoints)
{
  // Three sides in common: of two, shape leaves the direction along them free.
  const PartialModel model = placed(boxSides(true, 0.0007F, 3), T_b_box_);
  const MatchedSurface same_sides(model, 1);
  PairIcpOptions coarse;
  coarse.gate_m = 0.02;
  coarse.last_gate_m = 0.006;
  coarse.iterations = 20;
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    const Eigen::Isometry3f start = disturbed(T_a_b_, center_b_, 10 * MM_M, 8 * DEGREE_RAD, seed);
    const std::string what = "start " + std::to_string(seed);
    expectNear(alignByIcp(a_, same_sides, start, coarse), T_a_b_, center_b_, 2, 2, what);
    expectNear(alignByIcp(same_sides, a_, start.inverse(), coarse), T_a_b_.inverse(), center_a_, 2, 2,
               what + ", a on b");
  }
}

PairIcpOptions fine(ColorDetail color)
{
  PairIcpOptions options;
  options.coarse = false;
  options.gate_m = 0.005;
  options.last_gate_m = 0.002;
  options.iterations = 30;
  options.color = color;
  return options;
}

/// A plate of 100 x 100 mm.
PartialModel plate(const ColorAt& color)
{
  PartialModel part = madePart();
  addPatch({ -0.05F, -0.05F, 0 }, X, Y, 50, 50, color, &part);
  return part;
}

TEST(PairIcpFreedom, APlainPlateStaysWhereNothingHoldsIt)
{
  const PartialModel model = plate(plain);
  const MatchedSurface part(model, 1);
  const Eigen::Isometry3f start = pose({ 0.003F, -0.002F, 0.002F }, 0.03F, Z);
  const Eigen::Isometry3f T = alignByIcp(part, part, start, fine(ColorDetail::BLURRED));
  EXPECT_NEAR(T.translation().x(), 0.003, 2e-4);
  EXPECT_NEAR(T.translation().y(), -0.002, 2e-4);
  EXPECT_NEAR(T.translation().z(), 0, 2e-5);
  EXPECT_NEAR(angle_deg(T) * DEGREE_RAD, 0.03, 2e-3);
}

TEST(PairIcpFreedom, PrintHoldsAPlate)
{
  const PartialModel model = plate(texture);
  const MatchedSurface part(model, 1);
  for (const ColorDetail detail : { ColorDetail::BLURRED, ColorDetail::SHARP })
    for (const float sign : { 1.0F, -1.0F })
    {
      const Eigen::Isometry3f start = pose({ sign * 0.003F, sign * -0.002F, 0.002F }, sign * 0.03F, Z);
      const Eigen::Isometry3f T = alignByIcp(part, part, start, fine(detail));
      expectNear(T, Eigen::Isometry3f::Identity(), Eigen::Vector3f::Zero(), 0.1, 0.1, "texture");
    }
  const Eigen::Isometry3f without = alignByIcp(part, part, pose({ 0.003F, 0, 0 }, 0, Z), fine(ColorDetail::NONE));
  EXPECT_NEAR(without.translation().x(), 0.003, 2e-4) << "not asked for";
}

TEST(PairIcpFreedom, LeavesAPoseThatBringsNothingTogether)
{
  const PartialModel model = plate(texture);
  const MatchedSurface part(model, 1);
  PartialModel few_model = madePart();
  addPatch({ 0, 0, 0 }, X, Y, 3, 3, texture, &few_model);
  const MatchedSurface few(few_model, 1);
  const Eigen::Isometry3f away = pose({ 0, 0, 0.3F }, 0.1F, X), near = pose({ 0, 0, 0.001F }, 0, X);
  const Eigen::Isometry3f turned = pose({ 0, 0, 0 }, static_cast<float>(M_PI), X);
  for (const bool coarse : { true, false })
  {
    PairIcpOptions options = fine(ColorDetail::BLURRED);
    options.coarse = coarse;
    EXPECT_EQ(alignByIcp(part, part, away, options).matrix(), away.matrix()) << "too far";
    EXPECT_EQ(alignByIcp(part, part, turned, options).matrix(), turned.matrix()) << "facing away";
    EXPECT_EQ(alignByIcp(few, few, near, options).matrix(), near.matrix()) << "fewer than 20 pairs";
    const PartialModel none_model = madePart();
    const MatchedSurface none(none_model, 1);
    EXPECT_EQ(alignByIcp(none, part, near, options).matrix(), near.matrix()) << "no points";
    EXPECT_EQ(alignByIcp(part, none, near, options).matrix(), near.matrix()) << "no points";
  }
}

}  // namespace
}  // namespace object_modelling::registration
