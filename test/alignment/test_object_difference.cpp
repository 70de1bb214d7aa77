#include "object_modelling/alignment/object_difference.h"

#include <cmath>

#include <gtest/gtest.h>

#include "registration/made_part.h"

namespace object_modelling::alignment
{
namespace
{
using registration::X, registration::Y, registration::Z;

/// A plate of 160 x 160 mm about the origin, normal z.
registration::PartialModel plate(const registration::ColorAt& color)
{
  constexpr int COUNT = 80;
  registration::PartialModel part = registration::madePart(registration::SPACING_M);
  const float half = registration::SPACING_M * (COUNT - 1) / 2;
  registration::addPatch({ -half, -half, 0 }, X, Y, COUNT, COUNT, color, &part);
  return part;
}

ObjectDifference between(const registration::PartialModel& a, const registration::PartialModel& b,
                         const Eigen::Isometry3f& best, const Eigen::Isometry3f& rival)
{
  const registration::MatchedSurface part_a(a, 1), part_b(b, 1);
  return PoseComparison(part_a, part_b, best).differenceOf(rival);
}

Eigen::Isometry3f turned_deg(float angle_deg)
{
  return registration::pose({ 0, 0, 0 }, angle_deg * static_cast<float>(M_PI) / 180, Z);
}

TEST(ObjectDifference, NothingForASymmetry)
{
  const registration::PartialModel a = plate(registration::plain);
  for (const float angle_deg : { 0.F, 90.F, 180.F, 270.F })
  {
    const ObjectDifference found = between(a, a, turned_deg(90), turned_deg(90 + angle_deg));
    EXPECT_EQ(found.stray_ratio, 0) << angle_deg;
    EXPECT_LT(found.unknown_ratio, 0.01) << angle_deg;
    EXPECT_EQ(found.color_variance, 0) << angle_deg;
  }
}

TEST(ObjectDifference, TellsWhatIsLookedThroughFromWhatNobodySaw)
{
  registration::PartialModel a = plate(registration::plain);
  const Eigen::Isometry3f aside = registration::pose({ 0.046F, 0, 0 }, 0, Z);
  // 46 mm of 160 mm, less 6 mm that count as found.
  const ObjectDifference unseen = between(a, a, Eigen::Isometry3f::Identity(), aside);
  EXPECT_EQ(unseen.stray_ratio, 0);
  EXPECT_NEAR(unseen.unknown_ratio, 40.0 / 160, 0.03);
  a.views = { registration::viewAlongZ(1.1F), registration::viewAlongZ(1.1F) };
  const ObjectDifference seen = between(a, a, Eigen::Isometry3f::Identity(), aside);
  EXPECT_NEAR(seen.stray_ratio, 40.0 / 160, 0.03);
  EXPECT_LT(seen.unknown_ratio, 0.03);
}

TEST(ObjectDifference, IsTheSameEitherWay)
{
  registration::PartialModel a = plate(registration::plain), b = plate(registration::plain);
  a.views = { registration::viewAlongZ(1.1F), registration::viewAlongZ(1.1F) };
  const Eigen::Isometry3f best = turned_deg(30), rival = registration::pose({ 0.03F, 0, 0 }, 0.2F, Z);
  const ObjectDifference one = between(a, b, best, rival), other = between(b, a, best.inverse(), rival.inverse());
  EXPECT_GT(one.stray_ratio, 0.05);
  EXPECT_NEAR(one.stray_ratio, other.stray_ratio, 1e-3);
  EXPECT_NEAR(one.unknown_ratio, other.unknown_ratio, 1e-3);
}

TEST(ObjectDifference, MeasuresColorsThatMeet)
{
  // Half turned, each half meets the other: all points differ by 0.4 but those at the border, whose colour is blurred.
  const registration::PartialModel a =
      plate([](const Eigen::Vector3f& p) { return Eigen::Vector3f(p.x() > 0 ? 0.4F : 0, 0, 0); });
  EXPECT_NEAR(between(a, a, Eigen::Isometry3f::Identity(), turned_deg(180)).color_variance, 0.16, 0.02);
  EXPECT_LT(between(a, a, Eigen::Isometry3f::Identity(), turned_deg(0)).color_variance, 1e-6);
}

TEST(ObjectDifference, CountsOtherPrintBeyondTheNoiseOfTheSessions)
{
  const auto striped = [](float difference)
  { return [=](const Eigen::Vector3f& p) { return Eigen::Vector3f(p.x() > 0.04F ? difference : 0, 0, 0); }; };
  // A quarter of the plate is printed: half of it meets other texture when it is half turned.
  const registration::PartialModel a = plate(striped(0.4F));
  EXPECT_NEAR(between(a, a, Eigen::Isometry3f::Identity(), turned_deg(180)).other_texture_ratio, 0.5, 0.05);
  EXPECT_LT(between(a, a, Eigen::Isometry3f::Identity(), turned_deg(0)).other_texture_ratio, 0.01);
  const registration::PartialModel faint = plate(striped(0.1F));
  EXPECT_EQ(between(faint, faint, Eigen::Isometry3f::Identity(), turned_deg(180)).other_texture_ratio, 0);
  // Sessions that differ as much by themselves tell nothing of it.
  const registration::PartialModel b = plate(registration::plain);
  EXPECT_LT(between(a, b, Eigen::Isometry3f::Identity(), turned_deg(180)).other_texture_ratio, 0.1);
}

TEST(ObjectDifference, OfNoPointsIsNone)
{
  const registration::PartialModel nothing = registration::madePart(registration::SPACING_M);
  const ObjectDifference found =
      between(nothing, nothing, Eigen::Isometry3f::Identity(), registration::pose({ 0.1F, 0, 0 }, 1, Z));
  EXPECT_EQ(found.stray_ratio, 0);
  EXPECT_EQ(found.unknown_ratio, 0);
  EXPECT_EQ(found.color_variance, 0);
}

TEST(SameObjectProbability, FallsWithEachDifference)
{
  EXPECT_GT(sameObjectProbability({}, 0), 0.9);
  double before = 1;
  for (const double stray : { 0.0, 0.01, 0.05, 0.2, 1.0 })
  {
    const double now = sameObjectProbability({ stray, 0, 0.01 }, 0);
    EXPECT_LT(now, before) << stray;
    before = now;
  }
  EXPECT_LT(before, 0.2);
  EXPECT_LT(sameObjectProbability({ 0, 0, 0.5 }, 0), sameObjectProbability({ 0, 0, 0.01 }, 0));
  EXPECT_LT(sameObjectProbability({ 0, 0, 0.01 }, 3), sameObjectProbability({ 0, 0, 0.01 }, 0));
  EXPECT_GT(sameObjectProbability({ 0, MAX_UNKNOWN_RATIO, 0 }, 0), 0.9);
  EXPECT_EQ(sameObjectProbability({ 0, MAX_UNKNOWN_RATIO + 0.001, 0 }, 0), 0) << "nobody knows";
  EXPECT_GT(sameObjectProbability({ 0, 0, 0, MAX_OTHER_TEXTURE_RATIO }, 0), 0.9);
  EXPECT_EQ(sameObjectProbability({ 0, 0, 0, MAX_OTHER_TEXTURE_RATIO + 0.001 }, 0), 0) << "other texture";
  EXPECT_EQ(sameObjectProbability({}, 100), sameObjectProbability({}, MAX_RIVALRY)) << "bounded";
  EXPECT_EQ(sameObjectProbability({}, -3), sameObjectProbability({}, 0)) << "a better one is a rival at any distance";
}

TEST(DifferenceFeature, HasTheNamesThatTheFitKnows)
{
  EXPECT_STREQ(nameOf(DifferenceFeature::STRAY), "stray");
  EXPECT_STREQ(nameOf(DifferenceFeature::TEXTURE), "texture");
  EXPECT_STREQ(nameOf(DifferenceFeature::RIVALRY), "rivalry");
}

}  // namespace
}  // namespace object_modelling::alignment
