#include "pair_decision.h"

#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/alignment/object_difference.h"
#include "object_modelling/alignment/pair_evidence.h"
#include "registration/made_part.h"

namespace object_modelling::alignment
{
namespace
{
using registration::X, registration::Y, registration::Z;

/// Figures of a pose that is right: turned over, touching, texture that agrees.
registration::PairQuality good()
{
  registration::PairQuality quality;
  quality.overlap_ratio = 0.6;
  quality.rmse_m = quality.contact_gap_m = 5e-4;
  quality.foot_m = 0.005;
  quality.turn_rad = M_PI / 2;
  quality.roughness_m = 3e-4;
  quality.color_agreement = 0.8;
  quality.edge_agreement = 0.7;
  quality.texture = quality.edge_strength = 0.2;
  return quality;
}

/// The same of a surface without texture: less is known.
registration::PairQuality bare()
{
  registration::PairQuality quality = good();
  quality.color_agreement = quality.edge_agreement = quality.texture = quality.edge_strength = 0;
  return quality;
}

PairCandidate candidate(const registration::PairQuality& quality,
                        const Eigen::Isometry3f& T_a_b = Eigen::Isometry3f::Identity())
{
  return { ProposalKind::SHAPE, T_a_b.cast<double>(), quality };
}

/// A plate about the origin, normal z.
registration::PartialModel plate(int count_x, int count_y, const registration::ColorAt& color,
                                 float spacing_m = registration::SPACING_M)
{
  registration::PartialModel part = registration::madePart(spacing_m);
  const Eigen::Vector3f corner(static_cast<float>(1 - count_x), static_cast<float>(1 - count_y), 0);
  registration::addPatch(0.5F * spacing_m * corner, X, Y, count_x, count_y, color, &part);
  return part;
}

PairAlignment decided(const registration::PartialModel& a, const registration::PartialModel& b,
                      const std::vector<PairCandidate>& candidates, const PairAlignmentOptions& options = {})
{
  const registration::MatchedSurface part_a(a, 1), part_b(b, 1);
  PairAlignment result;
  result.accepted = true;
  result.candidates = candidates;
  decide(part_a, part_b, options, &result);
  EXPECT_EQ(result.accepted, result.reason.empty());
  return result;
}

/// Of one candidate, where the parts themselves do not matter.
PairAlignment decided(const registration::PairQuality& quality, const PairAlignmentOptions& options = {})
{
  const registration::PartialModel any = plate(10, 10, registration::plain);
  return decided(any, any, { candidate(quality) }, options);
}

double oddsOf(const registration::PairQuality& quality)
{
  return std::exp(logOdds(quality, PairAlignmentOptions().same_pose_probability));
}

void expectReason(const PairAlignment& result, const std::string& words)
{
  EXPECT_FALSE(result.accepted) << words;
  EXPECT_NE(result.reason.find(words), std::string::npos) << result.reason;
}

/// What a refusal says would lie elsewhere; negative if it does not say so.
int elsewhere_percent(const PairAlignment& result)
{
  const std::string before = "score alike, and ", after = " % of the surface would lie elsewhere";
  const std::size_t from = result.reason.find(before), to = result.reason.find(after);
  return from == std::string::npos || to == std::string::npos ? -1
                                                              : std::stoi(result.reason.substr(from + before.size()));
}

TEST(PairDecision, AcceptsWhatIsProbableEnough)
{
  const PairAlignment found = decided(bare());
  EXPECT_TRUE(found.accepted) << found.reason;
  const double probability = oddsOf(bare()) / (1 + oddsOf(bare()));
  EXPECT_NEAR(found.candidates[0].quality.probability, probability, 1e-12);
  PairAlignmentOptions options;
  options.min_probability = probability - 1e-6;
  EXPECT_TRUE(decided(bare(), options).accepted);
  options.min_probability = probability + 1e-6;
  EXPECT_FALSE(decided(bare(), options).accepted);
}

TEST(PairDecision, RefusesWithoutACandidate)
{
  const registration::PartialModel any = plate(10, 10, registration::plain);
  const PairAlignment found = decided(any, any, {});
  expectReason(found, "no pose brings as much as 6 % of the surfaces together");
  EXPECT_TRUE(found.candidates.empty());
}

TEST(PairDecision, RefusesTooLittleInCommonHoweverProbable)
{
  registration::PairQuality quality = good();
  quality.overlap_ratio = 0.11;
  expectReason(decided(quality), "overlap 11 % below 12 %");
  quality.overlap_ratio = 0.121;
  EXPECT_TRUE(decided(quality).accepted);
}

TEST(PairDecision, RefusesEmptySpaceHoweverProbable)
{
  registration::PairQuality quality = good();
  quality.fsv_ratio = 0.051;
  expectReason(decided(quality), "5 % of the surface would be where the other session saw that nothing is");
  EXPECT_GT(decided(quality).candidates[0].quality.probability, 0.9);
  quality.fsv_ratio = 0.049;
  EXPECT_TRUE(decided(quality).accepted);
}

TEST(PairDecision, NamesWhatSpeaksMostAgainstAPose)
{
  PairAlignmentOptions options;
  options.min_probability = 0.99;
  registration::PairQuality colors = bare(), contact = bare(), space = bare(), fit = bare(), stayed = bare();
  colors.texture = colors.edge_strength = 0.3;
  colors.color_agreement = colors.edge_agreement = -0.9;
  expectReason(decided(colors, options), "colours disagree (correlation -90 %");
  contact.contact_gap_m = 0.03;
  expectReason(decided(contact, options), "the object would be 30.0 mm off what it stood on");
  space.fsv_ratio = 0.048;
  expectReason(decided(space, options), "5 % of the surface would be where");
  fit.rmse_m = 0.02;
  expectReason(decided(fit, options), "surfaces are 20.0 mm apart");
  stayed.turn_rad = 0;
  stayed.contact_gap_m = stayed.foot_m;
  expectReason(decided(stayed, options), "not been turned over");
}

TEST(PairDecision, SaysWhereOnlyEvidenceIsWanting)
{
  PairAlignmentOptions options;
  options.min_probability = 0.9999;
  expectReason(decided(bare(), options), "nothing speaks against it, but too little for it");
  expectReason(decided(bare(), options), "(at least 100 % is needed)");
}

TEST(PairDecision, TakesTheSamePoseOnlyWhereItIsAllowedFor)
{
  registration::PairQuality stayed = good();
  stayed.turn_rad = 0.1;
  stayed.contact_gap_m = stayed.foot_m;
  const PairAlignment unasked = decided(stayed);
  expectReason(unasked, "not been turned over");
  EXPECT_GT(unasked.candidates[0].quality.probability, 0.7) << "though it is probable";
  PairAlignmentOptions options;
  options.same_pose_probability = 0.09;
  EXPECT_FALSE(decided(stayed, options).accepted);
  options.same_pose_probability = 0.1;
  EXPECT_TRUE(decided(stayed, options).accepted);
  stayed.turn_rad = -1;
  stayed.contact_gap_m = 0;
  EXPECT_TRUE(decided(stayed).accepted) << "nobody knows how it lay";
}

/// One session saw the middle of a plate of 160 x 80 mm, the other one all of it.
class DecisionOfAPlate : public testing::Test
{
protected:
  PairAlignment decidedOn(const std::vector<PairCandidate>& candidates) const
  {
    return decided(middle_, all_, candidates);
  }
  registration::PartialModel middle_ = plate(40, 40, registration::plain), all_ = plate(80, 40, registration::plain);
  const Eigen::Isometry3f half_ = registration::pose({ 0, 0, 0 }, static_cast<float>(M_PI), Z);
  const Eigen::Isometry3f quarter_ = registration::pose({ 0, 0, 0 }, static_cast<float>(M_PI) / 2, Z);
};

TEST_F(DecisionOfAPlate, SharesTheProbabilityBetweenPosesThatMakeOtherObjects)
{
  registration::PairQuality better = good(), worse = good();
  worse.rmse_m *= 1.3;
  const PairAlignment found = decidedOn({ candidate(better), candidate(worse, quarter_) });
  // 40 of 80 mm beyond the middle on either side, less 3 spacings that count as found, of the larger part's points; the
  // smaller one's all meet.
  expectReason(found, "two poses 90 deg apart score alike");
  EXPECT_NEAR(elsewhere_percent(found), 50 * (40 - 6) / 80.0 * 2500 / (2500 + 1600) * 2, 2);
  const double all = 1 + oddsOf(better) + oddsOf(worse);
  EXPECT_NEAR(found.candidates[0].quality.probability, oddsOf(better) / all, 1e-9);
  EXPECT_NEAR(found.candidates[1].quality.probability, oddsOf(worse) / all, 1e-9);
  worse.rmse_m = 0.1;
  EXPECT_TRUE(decidedOn({ candidate(better), candidate(worse, quarter_) }).accepted) << "no rival, so far worse";
}

TEST_F(DecisionOfAPlate, JoinsThePosesThatMakeTheSameObject)
{
  const PairAlignment found = decidedOn({ candidate(bare()), candidate(bare(), half_) });
  EXPECT_TRUE(found.accepted) << found.reason;
  const double same = sameObjectProbability({}, 0), all = 1 + 2 * oddsOf(bare());
  EXPECT_GT(same, 0.9);
  EXPECT_EQ(found.candidates[0].same_object_probability, 1);
  EXPECT_EQ(found.candidates[1].same_object_probability, same);
  EXPECT_NEAR(found.candidates[0].quality.probability, (1 + same) * oddsOf(bare()) / all, 1e-9);
  EXPECT_NEAR(found.candidates[1].quality.probability,
              oddsOf(bare()) / all + same * (found.candidates[0].quality.probability - oddsOf(bare()) / all), 1e-9);
}

TEST_F(DecisionOfAPlate, AnImpliedPoseCountsOnceWithThoseThatWereFound)
{
  PairCandidate implied = candidate(bare(), half_);
  implied.kind = ProposalKind::CYCLE;
  const double same = sameObjectProbability({}, 0), odds = oddsOf(bare()), left = (1 - same) * odds;
  const double alone = odds / (1 + odds), together = (odds + same * left) / (1 + odds + left);
  PairAlignment found = decidedOn({ candidate(bare()), implied });
  EXPECT_NEAR(found.candidates[0].quality.probability, together, 1e-9);
  EXPECT_NEAR(found.candidates[0].quality.probability, alone, 0.02) << "it makes the pair no more sure";
  EXPECT_GT(found.candidates[1].quality.probability, same * together) << "and is as good";
  found = decidedOn({ implied, candidate(bare()) });
  EXPECT_NEAR(found.candidates[0].quality.probability, alone, 0.02) << "whichever of them is first";
  implied = candidate(good(), quarter_);
  implied.kind = ProposalKind::CYCLE;
  expectReason(decidedOn({ candidate(good()), implied }), "two poses 90 deg apart score alike");
}

TEST_F(DecisionOfAPlate, CountsARivalByHowProbablyItMakesTheSameObject)
{
  // Views that look through what a quarter turn puts beside the plate.
  all_.views = middle_.views = { registration::viewAlongZ(1.1F), registration::viewAlongZ(1.1F) };
  const PairAlignment found = decidedOn({ candidate(bare()), candidate(bare(), half_), candidate(bare(), quarter_) });
  const registration::MatchedSurface a(middle_, 1), b(all_, 1);
  const auto same = [&](const Eigen::Isometry3f& rival)
  { return sameObjectProbability(PoseComparison(a, b, Eigen::Isometry3f::Identity()).differenceOf(rival), 0); };
  EXPECT_GT(same(half_), 0.9);
  EXPECT_LT(same(quarter_), 0.5);
  const double all = 1 + 3 * oddsOf(bare());
  EXPECT_NEAR(found.candidates[0].quality.probability, (1 + same(half_) + same(quarter_)) * oddsOf(bare()) / all, 1e-9);
  EXPECT_GT(found.candidates[0].quality.probability, found.candidates[1].quality.probability);
  EXPECT_GT(found.candidates[1].quality.probability, found.candidates[2].quality.probability + 0.1);
  expectReason(found, "two poses 90 deg apart score alike");
}

/// A plate of 160 x 160 mm, the same after half a turn but for what is printed on it.
PairAlignment decidedOfHalfTurn(const registration::ColorAt& color, const registration::PairQuality& quality = good())
{
  constexpr int COUNT = 160;
  const Eigen::Isometry3f half = registration::pose({ 0, 0, 0 }, static_cast<float>(M_PI), Z);
  const registration::PartialModel printed = plate(COUNT, COUNT, color, 0.001F);
  return decided(printed, printed, { candidate(quality), candidate(quality, half) });
}

TEST(PairDecision, PrintThatDiffersMakesTwoPosesLessTheSame)
{
  const auto half_painted = [](float difference)
  { return [=](const Eigen::Vector3f& p) { return Eigen::Vector3f(p.x() > 0 ? difference : 0, 0, 0); }; };
  const PairAlignment plain = decidedOfHalfTurn(registration::plain), faint = decidedOfHalfTurn(half_painted(0.1F)),
                      strong = decidedOfHalfTurn(half_painted(1.5F));
  EXPECT_TRUE(plain.accepted) << plain.reason;
  EXPECT_GT(plain.candidates[0].quality.probability, faint.candidates[0].quality.probability + 0.01);
  EXPECT_GT(faint.candidates[0].quality.probability, strong.candidates[0].quality.probability + 0.01);
  expectReason(strong, "two poses 180 deg apart score alike: the shape is symmetric, and the texture that both");
  registration::PairQuality pale = good();
  pale.texture = 0.04;
  expectReason(decidedOfHalfTurn(half_painted(1.5F), pale), "the sides that both sessions see are plain");
}

/// One session saw the plain middle of a plate only, the other all of it and a label on one end.
TEST(PairDecision, ALabelThatOneSessionSawMakesOtherObjects)
{
  const registration::PartialModel middle = plate(40, 40, registration::plain);
  for (const float difference : { 0.2F, 0.3F, 0.5F, 1.0F })
  {
    const registration::PartialModel all =
        plate(80, 40, [=](const Eigen::Vector3f& p) { return Eigen::Vector3f(p.x() > 0.045F ? difference : 0, 0, 0); });
    const Eigen::Isometry3f half = registration::pose({ 0, 0, 0 }, static_cast<float>(M_PI), Z);
    const PairAlignment found = decided(middle, all, { candidate(good()), candidate(good(), half) });
    expectReason(found, "two poses 180 deg apart score alike");
    EXPECT_NEAR(found.candidates[0].quality.probability, 0.5, 1e-3) << difference;
  }
}

TEST(PairDecision, SaysHowManyMakeTheSameObjectWhereTheyAreTooFew)
{
  PairAlignmentOptions options;
  options.min_probability = 0.9999;
  const registration::PartialModel any = plate(80, 80, registration::plain);
  const Eigen::Isometry3f half = registration::pose({ 0, 0, 0 }, static_cast<float>(M_PI), Z);
  const PairAlignment found = decided(any, any, { candidate(good()), candidate(good(), half) }, options);
  expectReason(found, "2 poses probably make the same object");
  EXPECT_EQ(found.reason.find("100 % only"), std::string::npos) << found.reason;
}

TEST(PairDecision, WhatIsNotANumberIsNotAccepted)
{
  registration::PairQuality broken = good();
  broken.rmse_m = std::nan("");
  const registration::PartialModel any = plate(10, 10, registration::plain);
  EXPECT_FALSE(decided(any, any, { candidate(good()), candidate(broken) }).accepted);
}

TEST(PairDecision, ATurnedPoseLeadsWhereItMakesTheSameObject)
{
  const registration::PartialModel plate_ = plate(80, 80, registration::plain);
  registration::PairQuality stayed = good(), turned = good();
  stayed.turn_rad = 0.1;
  stayed.contact_gap_m = stayed.foot_m;
  turned.rmse_m *= 40;
  ASSERT_GT(oddsOf(stayed), 0.1 * oddsOf(turned));
  const Eigen::Isometry3f half = registration::pose({ 0, 0, 0 }, static_cast<float>(M_PI), Z);
  const PairAlignment found = decided(plate_, plate_, { candidate(stayed), candidate(turned, half) });
  EXPECT_TRUE(found.accepted) << found.reason;
  EXPECT_EQ(found.candidates[0].quality.turn_rad, turned.turn_rad);
  turned.color_agreement = turned.edge_agreement = -0.9;
  ASSERT_LT(oddsOf(turned), 0.1);
  EXPECT_FALSE(decided(plate_, plate_, { candidate(stayed), candidate(turned, half) }).accepted)
      << "it would not do alone";
  turned = good();
  registration::PairQuality in_empty_space = good();
  in_empty_space.fsv_ratio = 0.055;
  EXPECT_TRUE(
      decided(plate_, plate_, { candidate(stayed), candidate(in_empty_space, half), candidate(turned, half) }).accepted)
      << "the next one leads";
  const Eigen::Isometry3f elsewhere = registration::pose({ 0, 0, 0.3F }, 0, Z);
  EXPECT_FALSE(decided(plate_, plate_, { candidate(stayed), candidate(turned, elsewhere) }).accepted);
}

}  // namespace
}  // namespace object_modelling::alignment
