#include "pair_decision.h"

#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/alignment/pair_evidence.h"
#include "registration/made_part.h"

namespace object_modelling::alignment
{
namespace
{
const Eigen::Vector3f X = Eigen::Vector3f::UnitX(), Y = Eigen::Vector3f::UnitY(), Z = Eigen::Vector3f::UnitZ();

/// Figures of a pose that is right: turned over, touching, print that agrees.
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

/// The same of a surface without print: less is known.
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
  ASSERT_TRUE(scoreAlike(better, worse));
  const PairAlignment found = decidedOn({ candidate(better), candidate(worse, quarter_) });
  // 40 of 80 mm beyond the middle on either side, less 3 spacings that count as found.
  expectReason(found, "two poses 90 deg apart score alike");
  EXPECT_NEAR(elsewhere_percent(found), 100 * (40 - 6) / 80.0, 2);
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
  const double both = 2 * oddsOf(bare()) / (1 + 2 * oddsOf(bare()));
  EXPECT_NEAR(found.candidates[0].quality.probability, both, 1e-12);
  EXPECT_NEAR(found.candidates[1].quality.probability, both, 1e-12);
  const PairAlignment third = decidedOn({ candidate(bare()), candidate(bare(), half_), candidate(bare(), quarter_) });
  const double all = 1 + 3 * oddsOf(bare());
  EXPECT_NEAR(third.candidates[0].quality.probability, 2 * oddsOf(bare()) / all, 1e-12);
  EXPECT_NEAR(third.candidates[1].quality.probability, 2 * oddsOf(bare()) / all, 1e-12);
  EXPECT_NEAR(third.candidates[2].quality.probability, oddsOf(bare()) / all, 1e-12);
  expectReason(third, "two poses 90 deg apart score alike");
}

TEST_F(DecisionOfAPlate, MayLieElsewhereByMoreWhereNobodyLooked)
{
  // 22 mm along 160 mm, of which 6 mm count as found: a tenth of it lies elsewhere.
  const std::vector<PairCandidate> two = { candidate(good()),
                                           candidate(good(), registration::pose({ 0.022F, 0, 0 }, 0, Z)) };
  EXPECT_TRUE(decidedOn(two).accepted);
  middle_.views = { registration::viewAlongZ(1.1F), registration::viewAlongZ(1.1F) };
  EXPECT_NEAR(elsewhere_percent(decidedOn(two)), 10, 1);
  middle_.views.clear();
  const std::vector<PairCandidate> far = { candidate(good()),
                                           candidate(good(), registration::pose({ 0.04F, 0, 0 }, 0, Z)) };
  EXPECT_NEAR(elsewhere_percent(decidedOn(far)), 100 * (40 - 6) / 160.0, 1);
}

/// A plate of 160 x 160 mm, the same after half a turn but for what is printed on it.
PairAlignment decidedOfHalfTurn(const registration::ColorAt& color, const registration::PairQuality& quality = good())
{
  constexpr int COUNT = 160;
  const Eigen::Isometry3f half = registration::pose({ 0, 0, 0 }, static_cast<float>(M_PI), Z);
  const registration::PartialModel printed = plate(COUNT, COUNT, color, 0.001F);
  return decided(printed, printed, { candidate(quality), candidate(quality, half) });
}

registration::ColorAt label(float side_m, float difference)
{
  return [=](const Eigen::Vector3f& p)
  {
    const bool on = std::max(std::abs(p.x() - 0.04F), std::abs(p.y() - 0.04F)) < side_m / 2;
    return Eigen::Vector3f(on ? difference : 0, 0, 0);
  };
}

TEST(PairDecision, ALabelAloneTellsTwoPosesApart)
{
  // 24 x 24 of 160 x 160 mm, there and where it is after half a turn: 4.5 % of the points differ by 0.45.
  constexpr double SHARE = 2 * 24.0 * 24 / (160 * 160), DIFFERENCE = 0.45;
  ASSERT_LT(DIFFERENCE * std::sqrt(SHARE), 0.1) << "the colours of the whole are the same";
  const PairAlignment found = decidedOfHalfTurn(label(0.024F, DIFFERENCE));
  expectReason(found, "two poses 180 deg apart score alike: the shape is symmetric, and the print that both");
  EXPECT_NEAR(found.candidates[0].quality.probability, 0.5, 1e-3);
  registration::PairQuality pale = good();
  pale.texture = 0.04;
  expectReason(decidedOfHalfTurn(label(0.024F, DIFFERENCE), pale), "the sides that both sessions see are plain");
}

TEST(PairDecision, WhatIsFaintOrSmallIsNoLabel)
{
  EXPECT_TRUE(decidedOfHalfTurn(label(0.024F, 0.3F)).accepted) << "light and focus may do as much";
  EXPECT_TRUE(decidedOfHalfTurn(label(0.014F, 0.45F)).accepted) << "1.5 % of the points";
  EXPECT_TRUE(decidedOfHalfTurn(registration::plain).accepted);
}

TEST(PairDecision, FaintPrintAllOverTellsTwoPosesApart)
{
  const auto half_painted = [](float difference)
  { return [=](const Eigen::Vector3f& p) { return Eigen::Vector3f(p.x() > 0 ? difference : 0, 0, 0); }; };
  EXPECT_FALSE(decidedOfHalfTurn(half_painted(0.15F)).accepted);
  EXPECT_TRUE(decidedOfHalfTurn(half_painted(0.07F)).accepted);
}

TEST(ScoreAlike, UpToSomeLogOdds)
{
  const registration::PairQuality best = bare();
  bool alike = false, apart = false;
  for (double factor = 1; factor < 5; factor *= 1.1)
  {
    registration::PairQuality rival = bare();
    rival.rmse_m *= factor;
    const bool near = logOdds(best, 0.5) - logOdds(rival, 0.5) <= 1.2;
    (near ? alike : apart) = true;
    EXPECT_EQ(scoreAlike(best, rival), near) << factor;
    EXPECT_TRUE(scoreAlike(rival, best)) << "a better one is a rival at any distance";
  }
  EXPECT_TRUE(alike && apart);
}

}  // namespace
}  // namespace object_modelling::alignment
