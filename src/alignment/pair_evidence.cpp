#include "object_modelling/alignment/pair_evidence.h"

#include <algorithm>
#include <cmath>

#include "pair_weights.h"

namespace object_modelling::alignment
{
namespace
{
static_assert(std::size(WEIGHTS) == FEATURE_COUNT);

constexpr double ENOUGH_OVERLAP = 0.3;
constexpr double FREE_FSV_RATIO = 0.004, MOST_FSV_RATIO = 0.1, FSV_UNIT_RATIO = 0.05;
constexpr double SURFACE_SIGMA_M = 0.0003;  // of fused surfaces, besides their roughness
constexpr double CONTACT_SIGMA_M = 0.0012;  // of a support plane, and of a foot that was seen
constexpr double MOST_CONTACT = 8;          // a gap beyond some sigmas is no worse
constexpr double COLOR_VARIANCE = 0.01,
                 COLOR_RATIO = 0.15;      // of colours of the same surface in two sessions; of texture
constexpr double EDGE_VARIANCE = 0.0025;  // of the slopes of the colours
constexpr double NOT_TURNED_RAD = 0.26, TURNED_RAD = 0.52;  // 15 and 30 deg: between them it may have been

/// How far a pose lets the object turn, from not at all, 1, to as far as needed, 0.
double notTurned(const registration::PairQuality& quality)
{
  if (quality.turn_rad < 0)
    return 0;
  return std::clamp((TURNED_RAD - quality.turn_rad) / (TURNED_RAD - NOT_TURNED_RAD), 0.0, 1.0);
}

double contactFeature(const registration::PairQuality& quality)
{
  // What was not turned over hides its foot in both sessions.
  const double gap_m = std::abs(quality.contact_gap_m - notTurned(quality) * std::max(0.0, quality.foot_m));
  const double sigma_m = std::hypot(CONTACT_SIGMA_M, quality.roughness_m);
  return -MOST_CONTACT * (1 - std::exp(-gap_m * gap_m / (2 * sigma_m * sigma_m * MOST_CONTACT)));
}

/// Logarithm of how much smaller a difference is than what varies at all.
double explained(double variance, double difference, double same_variance)
{
  return std::log((variance + same_variance) / (std::max(0.0, difference) + same_variance));
}
}  // namespace

const char* nameOf(Feature feature)
{
  switch (feature)
  {
    case Feature::OVERLAP:
      return "overlap";
    case Feature::SPACE:
      return "space";
    case Feature::THROUGH:
      return "through";
    case Feature::FIT:
      return "fit";
    case Feature::CONTACT:
      return "contact";
    case Feature::TEXTURE:
      return "texture";
    case Feature::COLOR:
      return "color";
    case Feature::EDGES:
      return "edges";
    case Feature::FEATURES:
    case Feature::COUNT:
      break;
  }
  return "features";
}

FeatureVector featuresOf(const registration::PairQuality& quality)
{
  FeatureVector result{};
  const auto at = [&](Feature feature) -> double& { return result[static_cast<std::size_t>(feature)]; };
  at(Feature::OVERLAP) = std::min(quality.overlap_ratio, ENOUGH_OVERLAP) - ENOUGH_OVERLAP;
  at(Feature::SPACE) = -std::log1p(quality.fsv_ratio / FREE_FSV_RATIO);
  at(Feature::THROUGH) = -std::min(quality.fsv_ratio, MOST_FSV_RATIO) / FSV_UNIT_RATIO;
  at(Feature::FIT) = -std::log(std::max(quality.rmse_m, 1e-5) / std::hypot(SURFACE_SIGMA_M, quality.roughness_m));
  at(Feature::CONTACT) = contactFeature(quality);
  // A small overlap is weak evidence of texture.
  const double share = std::min(1.0, quality.overlap_ratio / ENOUGH_OVERLAP);
  const double variance = quality.texture * quality.texture, edges = quality.edge_strength * quality.edge_strength;
  const double difference = variance * (1 - quality.color_agreement) - quality.light_variance;
  at(Feature::TEXTURE) = share * explained(variance, COLOR_RATIO * variance, COLOR_VARIANCE);
  at(Feature::COLOR) = share * explained(variance, difference, COLOR_VARIANCE);
  at(Feature::EDGES) = share * explained(edges, edges * (1 - quality.edge_agreement), EDGE_VARIANCE);
  at(Feature::FEATURES) = std::log1p(quality.features_upheld);
  return result;
}

bool impliesNotTurned(const registration::PairQuality& quality)
{
  return notTurned(quality) >= 0.5;
}

double turnPrior(const registration::PairQuality& quality, double same_pose_probability)
{
  return notTurned(quality) *
         std::log(std::max(same_pose_probability, 1e-6) / std::max(1 - same_pose_probability, 1e-6));
}

FeatureVector contributions(const registration::PairQuality& quality)
{
  FeatureVector result = featuresOf(quality);
  for (std::size_t i = 0; i < FEATURE_COUNT; ++i)
    result[i] *= WEIGHTS[i];
  return result;
}

double logOdds(const registration::PairQuality& quality, double same_pose_probability)
{
  double sum = WEIGHT_BIAS + turnPrior(quality, same_pose_probability);
  for (const double contribution : contributions(quality))
    sum += contribution;
  return sum;
}

}  // namespace object_modelling::alignment
