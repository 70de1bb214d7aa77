#include "object_modelling/alignment/pair_evidence.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace object_modelling::alignment
{
namespace
{
double valueOf(Feature feature, const registration::PairQuality& quality)
{
  return featuresOf(quality)[static_cast<std::size_t>(feature)];
}

/// A pose like those that are right: turned over, touching, texture that agrees.
registration::PairQuality goodQuality()
{
  registration::PairQuality quality;
  quality.overlap_ratio = 0.6;
  quality.rmse_m = 5e-4;
  quality.contact_gap_m = 5e-4;
  quality.foot_m = 0.005;
  quality.turn_rad = M_PI / 2;
  quality.roughness_m = 3e-4;
  quality.color_agreement = 0.8;
  quality.texture = 0.2;
  quality.edge_agreement = 0.7;
  quality.edge_strength = 0.2;
  quality.features_upheld = 20;
  return quality;
}

TEST(PairEvidence, NamesEveryFeatureOnce)
{
  std::set<std::string> names;
  for (std::size_t i = 0; i < FEATURE_COUNT; ++i)
    names.insert(nameOf(static_cast<Feature>(i)));
  EXPECT_EQ(names.size(), FEATURE_COUNT);
}

TEST(PairEvidence, HoldsAgainstAPoseThatTheObjectWasNotTurnedOver)
{
  registration::PairQuality quality = goodQuality();
  EXPECT_EQ(turnPrior(quality, 0.01), 0);
  quality.turn_rad = 0;
  EXPECT_NEAR(turnPrior(quality, 0.01), std::log(0.01 / 0.99), 1e-12);
  EXPECT_NEAR(turnPrior(quality, 0.5), 0, 1e-12) << "as often as not";
  quality.turn_rad = 0.4;  // 23 deg
  EXPECT_LT(turnPrior(quality, 0.01), 0);
  EXPECT_GT(turnPrior(quality, 0.01), std::log(0.01 / 0.99));
  quality.turn_rad = -1;
  EXPECT_EQ(turnPrior(quality, 0.01), 0) << "not known";
  EXPECT_TRUE(std::isfinite(turnPrior(goodQuality(), 0)));
}

TEST(PairEvidence, WantsTheObjectToTouchWhatItStoodOn)
{
  registration::PairQuality floats = goodQuality();
  floats.contact_gap_m = 0.005;
  EXPECT_LT(valueOf(Feature::CONTACT, floats), valueOf(Feature::CONTACT, goodQuality()) - 1);
  // Not turned over, what was hidden at the foot is hidden in both.
  floats.turn_rad = 0;
  EXPECT_NEAR(valueOf(Feature::CONTACT, floats), 0, 1e-9);
  floats.contact_gap_m = 0;
  EXPECT_LT(valueOf(Feature::CONTACT, floats), -1);
}

TEST(PairEvidence, TakesRoughSurfacesForLessExact)
{
  registration::PairQuality rough = goodQuality();
  rough.contact_gap_m = rough.rmse_m = 0.002;
  registration::PairQuality smooth = rough;
  rough.roughness_m = 0.002;
  EXPECT_GT(valueOf(Feature::CONTACT, rough), valueOf(Feature::CONTACT, smooth));
  EXPECT_GT(valueOf(Feature::FIT, rough), valueOf(Feature::FIT, smooth));
}

TEST(PairEvidence, DoesNotPrizeOverlapBeyondAThird)
{
  registration::PairQuality all = goodQuality(), little = goodQuality();
  all.overlap_ratio = 1;
  EXPECT_EQ(valueOf(Feature::OVERLAP, all), valueOf(Feature::OVERLAP, goodQuality()));
  little.overlap_ratio = 0.15;
  EXPECT_LT(valueOf(Feature::OVERLAP, little), valueOf(Feature::OVERLAP, goodQuality()));
}

TEST(PairEvidence, TellsPrintThatAgreesFromOtherAndFromNone)
{
  const auto of_texture = [](const registration::PairQuality& quality)
  {
    const FeatureVector values = contributions(quality);
    double sum = 0;
    for (const Feature feature : { Feature::TEXTURE, Feature::COLOR, Feature::EDGES })
      sum += values[static_cast<std::size_t>(feature)];
    return sum;
  };
  registration::PairQuality other = goodQuality(), plain = goodQuality(), relit = goodQuality();
  other.color_agreement = other.edge_agreement = 0;
  plain.texture = plain.edge_strength = 0;
  relit.color_agreement = 0.4;
  EXPECT_NEAR(of_texture(plain), 0, 1e-9);
  EXPECT_GT(of_texture(goodQuality()), of_texture(other) + 2);
  EXPECT_LT(valueOf(Feature::COLOR, relit), valueOf(Feature::COLOR, goodQuality()));
  relit.light_variance = 0.02;
  EXPECT_GT(valueOf(Feature::COLOR, relit), valueOf(Feature::COLOR, goodQuality())) << "as much as light explains";
}

TEST(PairEvidence, HoldsAHandleThatIsElsewhereAgainstAPose)
{
  registration::PairQuality handle = goodQuality();
  handle.fsv_ratio = 0.06;
  EXPECT_LT(logOdds(handle, 0.01), logOdds(goodQuality(), 0.01) - 2);
}

TEST(PairEvidence, HasKnownValues)
{
  registration::PairQuality quality = goodQuality();
  quality.overlap_ratio = 0.1;
  EXPECT_NEAR(valueOf(Feature::OVERLAP, quality), -0.2, 1e-12);
  quality.fsv_ratio = 0.004;
  EXPECT_NEAR(valueOf(Feature::SPACE, quality), -std::log(2), 1e-12);
  EXPECT_NEAR(valueOf(Feature::THROUGH, quality), -0.08, 1e-12);
  quality.fsv_ratio = 1;
  EXPECT_NEAR(valueOf(Feature::SPACE, quality), -std::log(251), 1e-12);
  EXPECT_NEAR(valueOf(Feature::THROUGH, quality), -2, 1e-12) << "0.1 is the most";
  // Roughness 0.4 mm and 0.3 mm of fused surfaces: 0.5 mm.
  quality.roughness_m = 4e-4;
  quality.rmse_m = 5e-4 * std::exp(1);
  EXPECT_NEAR(valueOf(Feature::FIT, quality), -1, 1e-12);
  // 0.5 mm and 1.2 mm of planes: 1.3 mm. A gap of 1.3 mm, and of any number of them.
  quality.roughness_m = 5e-4;
  quality.contact_gap_m = 0.0013;
  EXPECT_NEAR(valueOf(Feature::CONTACT, quality), -8 * (1 - std::exp(-1.0 / 16)), 1e-9);
  quality.contact_gap_m = 1;
  EXPECT_NEAR(valueOf(Feature::CONTACT, quality), -8, 1e-9);
  quality.features_upheld = std::exp(2) - 1;
  EXPECT_NEAR(valueOf(Feature::FEATURES, quality), 2, 1e-12);
}

TEST(PairEvidence, HasKnownValuesOfPrint)
{
  // Variance 0.01 of the colours, 0.0025 of their slopes: as much as between sessions.
  registration::PairQuality quality = goodQuality();
  quality.texture = 0.1;
  quality.edge_strength = 0.05;
  quality.color_agreement = quality.edge_agreement = 1;
  EXPECT_NEAR(valueOf(Feature::TEXTURE, quality), std::log(0.02 / 0.0115), 1e-12);
  EXPECT_NEAR(valueOf(Feature::COLOR, quality), std::log(2), 1e-12);
  EXPECT_NEAR(valueOf(Feature::EDGES, quality), std::log(2), 1e-12);
  quality.color_agreement = quality.edge_agreement = 0;
  EXPECT_NEAR(valueOf(Feature::COLOR, quality), 0, 1e-12);
  EXPECT_NEAR(valueOf(Feature::EDGES, quality), 0, 1e-12);
  quality.color_agreement = quality.edge_agreement = -1;
  EXPECT_NEAR(valueOf(Feature::COLOR, quality), std::log(0.02 / 0.03), 1e-12);
  EXPECT_NEAR(valueOf(Feature::EDGES, quality), std::log(0.005 / 0.0075), 1e-12);
  quality.light_variance = 0.02;
  EXPECT_NEAR(valueOf(Feature::COLOR, quality), std::log(2), 1e-12) << "light explains all of it";
  quality.light_variance = 1;
  EXPECT_NEAR(valueOf(Feature::COLOR, quality), std::log(2), 1e-12) << "and no more than that";
  quality.overlap_ratio = 0.1;
  EXPECT_NEAR(valueOf(Feature::COLOR, quality), std::log(2) / 3, 1e-12) << "a third of enough overlap";
}

/// The log odds as one figure goes from one value to another, all else as of a pose that is right.
std::vector<double> sweep(double registration::PairQuality::*figure, double from, double to,
                          registration::PairQuality quality = goodQuality())
{
  constexpr int STEPS = 50;
  std::vector<double> odds;
  for (int i = 0; i <= STEPS; ++i)
  {
    quality.*figure = from + (to - from) * i / STEPS;
    odds.push_back(logOdds(quality, 0.01));
  }
  return odds;
}

/// Nowhere down, and up by something in all.
void expectRising(const std::vector<double>& odds, const char* what)
{
  EXPECT_TRUE(std::is_sorted(odds.begin(), odds.end())) << what;
  EXPECT_GT(odds.back(), odds.front() + 0.1) << what;
}

TEST(PairEvidence, OddsOnlyRiseAsAPoseFitsBetter)
{
  expectRising(sweep(&registration::PairQuality::overlap_ratio, 0, 1), "overlap");
  expectRising(sweep(&registration::PairQuality::fsv_ratio, 1, 0), "empty space");
  expectRising(sweep(&registration::PairQuality::rmse_m, 0.01, 0), "distance");
  expectRising(sweep(&registration::PairQuality::contact_gap_m, 0.05, 0), "gap");
  expectRising(sweep(&registration::PairQuality::color_agreement, -1, 1), "colours");
  expectRising(sweep(&registration::PairQuality::edge_agreement, -1, 1), "slopes");
  expectRising(sweep(&registration::PairQuality::features_upheld, 0, 500), "features");
  expectRising(sweep(&registration::PairQuality::turn_rad, 0, M_PI), "turn");
  registration::PairQuality opposite = goodQuality();
  opposite.color_agreement = opposite.edge_agreement = -1;
  expectRising(sweep(&registration::PairQuality::light_variance, 0, 0.1, opposite), "light");
  expectRising(sweep(&registration::PairQuality::texture, 1, 0, opposite), "texture that disagrees");
  expectRising(sweep(&registration::PairQuality::edge_strength, 1, 0, opposite), "slopes that disagree");
  expectRising(sweep(&registration::PairQuality::edge_strength, 0, 1), "slopes that agree");
  registration::PairQuality off = goodQuality();
  off.rmse_m = off.contact_gap_m = 0.003;
  expectRising(sweep(&registration::PairQuality::roughness_m, 0, 0.002, off), "roughness, of what is off");
}

TEST(PairEvidence, OddsRiseWithHowOftenObjectsStayAsTheyLay)
{
  registration::PairQuality stayed = goodQuality();
  stayed.turn_rad = 0;
  double last = -INFINITY;
  for (const double probability : { 0.0, 0.001, 0.01, 0.1, 0.5, 0.9, 1.0 })
  {
    EXPECT_GT(logOdds(stayed, probability), last) << probability;
    EXPECT_TRUE(std::isfinite(logOdds(stayed, probability))) << probability;
    EXPECT_EQ(logOdds(goodQuality(), probability), logOdds(goodQuality(), 0.5)) << "it was turned";
    last = logOdds(stayed, probability);
  }
}

TEST(PairEvidence, SaysNotTurnedUpToHalfWayBetween15And30Degrees)
{
  registration::PairQuality quality = goodQuality();
  for (const auto& [degrees, stayed] : { std::pair(0, true), { 15, true }, { 22, true }, { 23, false }, { 90, false } })
  {
    quality.turn_rad = degrees * M_PI / 180;
    EXPECT_EQ(impliesNotTurned(quality), stayed) << degrees;
  }
  quality.turn_rad = -1;
  EXPECT_FALSE(impliesNotTurned(quality)) << "not known";
}

TEST(PairEvidence, OfDegenerateFiguresIsFinite)
{
  registration::PairQuality exact;
  exact.overlap_ratio = exact.color_agreement = exact.edge_agreement = exact.texture = exact.edge_strength = 1;
  for (const registration::PairQuality& quality : { registration::PairQuality(), exact })
    for (std::size_t i = 0; i < FEATURE_COUNT; ++i)
      EXPECT_TRUE(std::isfinite(featuresOf(quality)[i])) << nameOf(static_cast<Feature>(i));
}

TEST(PairEvidence, AddsUp)
{
  const registration::PairQuality quality = goodQuality();
  double sum = 0;
  for (const double contribution : contributions(quality))
    sum += contribution;
  EXPECT_NEAR(
      logOdds(quality, 0.01) - logOdds(registration::PairQuality(), 0.01),
      sum -
          []
          {
            double none = 0;
            for (const double contribution : contributions(registration::PairQuality()))
              none += contribution;
            return none;
          }(),
      1e-9);
}

}  // namespace
}  // namespace object_modelling::alignment
