#include "object_modelling/alignment/pair_evidence.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace object_modelling::alignment
{
namespace
{
double valueOf(Feature feature, const registration::PairQuality& quality)
{
  return featuresOf(quality)[static_cast<std::size_t>(feature)];
}

/// A pose like those that are right: turned over, touching, print that agrees.
registration::PairQuality good()
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
  registration::PairQuality quality = good();
  EXPECT_EQ(turnPrior(quality, 0.01), 0);
  quality.turn_rad = 0;
  EXPECT_NEAR(turnPrior(quality, 0.01), std::log(0.01 / 0.99), 1e-12);
  EXPECT_NEAR(turnPrior(quality, 0.5), 0, 1e-12) << "as often as not";
  quality.turn_rad = 0.4;  // 23 deg
  EXPECT_LT(turnPrior(quality, 0.01), 0);
  EXPECT_GT(turnPrior(quality, 0.01), std::log(0.01 / 0.99));
  quality.turn_rad = -1;
  EXPECT_EQ(turnPrior(quality, 0.01), 0) << "not known";
  EXPECT_TRUE(std::isfinite(turnPrior(good(), 0)));
}

TEST(PairEvidence, WantsTheObjectToTouchWhatItStoodOn)
{
  registration::PairQuality floats = good();
  floats.contact_gap_m = 0.005;
  EXPECT_LT(valueOf(Feature::CONTACT, floats), valueOf(Feature::CONTACT, good()) - 1);
  // Not turned over, what was hidden at the foot is hidden in both.
  floats.turn_rad = 0;
  EXPECT_NEAR(valueOf(Feature::CONTACT, floats), 0, 1e-9);
  floats.contact_gap_m = 0;
  EXPECT_LT(valueOf(Feature::CONTACT, floats), -1);
}

TEST(PairEvidence, TakesRoughSurfacesForLessExact)
{
  registration::PairQuality rough = good();
  rough.contact_gap_m = rough.rmse_m = 0.002;
  registration::PairQuality smooth = rough;
  rough.roughness_m = 0.002;
  EXPECT_GT(valueOf(Feature::CONTACT, rough), valueOf(Feature::CONTACT, smooth));
  EXPECT_GT(valueOf(Feature::FIT, rough), valueOf(Feature::FIT, smooth));
}

TEST(PairEvidence, DoesNotPrizeOverlapBeyondAThird)
{
  registration::PairQuality all = good(), little = good();
  all.overlap_ratio = 1;
  EXPECT_EQ(valueOf(Feature::OVERLAP, all), valueOf(Feature::OVERLAP, good()));
  little.overlap_ratio = 0.15;
  EXPECT_LT(valueOf(Feature::OVERLAP, little), valueOf(Feature::OVERLAP, good()));
}

TEST(PairEvidence, TellsPrintThatAgreesFromOtherAndFromNone)
{
  const auto of_print = [](const registration::PairQuality& quality)
  {
    const FeatureVector values = contributions(quality);
    double sum = 0;
    for (const Feature feature : { Feature::PRINT, Feature::COLOR, Feature::EDGES })
      sum += values[static_cast<std::size_t>(feature)];
    return sum;
  };
  registration::PairQuality other = good(), plain = good(), relit = good();
  other.color_agreement = other.edge_agreement = 0;
  plain.texture = plain.edge_strength = 0;
  relit.color_agreement = 0.4;
  EXPECT_NEAR(of_print(plain), 0, 1e-9);
  EXPECT_GT(of_print(good()), of_print(other) + 2);
  EXPECT_LT(valueOf(Feature::COLOR, relit), valueOf(Feature::COLOR, good()));
  relit.light_variance = 0.02;
  EXPECT_GT(valueOf(Feature::COLOR, relit), valueOf(Feature::COLOR, good())) << "as much as light explains";
}

TEST(PairEvidence, HoldsAHandleThatIsElsewhereAgainstAPose)
{
  registration::PairQuality handle = good();
  handle.fsv_ratio = 0.06;
  EXPECT_LT(logOdds(handle, 0.01), logOdds(good(), 0.01) - 2);
}

TEST(PairEvidence, AddsUp)
{
  const registration::PairQuality quality = good();
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
