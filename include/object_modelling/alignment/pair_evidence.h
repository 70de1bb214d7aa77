#pragma once

#include <array>

#include "object_modelling/alignment/pair_alignment.h"

namespace object_modelling::alignment
{
/// Evidence for a pose from its quality measures, each on a scale on which it is additive. docs/alignment.md: how the
/// weights were fitted.
enum class Feature
{
  OVERLAP,   ///< up to a third of the surface in common: beyond that it proves nothing more
  SPACE,     ///< that neither looks through the other, as a logarithm: how clean is it?
  THROUGH,   ///< the same as a share: a handle that is elsewhere is few of the points, but all of them
  FIT,       ///< distance of the surfaces, against how rough they are by themselves
  CONTACT,   ///< gap between either and what the other stood on, against its noise
  TEXTURE,   ///< how much texture there is to agree: where it does not, that speaks against the pose
  COLOR,     ///< share of the variance of the colours that both have alike, light that changed taken off
  EDGES,     ///< the same of the slopes of the colours
  FEATURES,  ///< matches of local features
  COUNT
};
constexpr auto FEATURE_COUNT = static_cast<std::size_t>(Feature::COUNT);
using FeatureVector = std::array<double, FEATURE_COUNT>;

/// "overlap", "space", ...
const char* nameOf(Feature feature);

FeatureVector featuresOf(const registration::PairQuality& quality);

/// Log odds of an object that was not turned over between two sessions against one that was, for a pose without a turn;
/// 0 for a pose with one, or where that is not known.
double turnPrior(const registration::PairQuality& quality, double same_pose_probability);

/// Whether, by a pose, the object lay in both sessions as in the other, or nearly so.
bool impliesNotTurned(const registration::PairQuality& quality);

/// Logarithmic odds of a pose against that none is right.
double logOdds(const registration::PairQuality& quality, double same_pose_probability);

/// Weight times feature: what each adds to the odds.
FeatureVector contributions(const registration::PairQuality& quality);

}  // namespace object_modelling::alignment
