#pragma once

#include "surface_pair.h"

namespace object_modelling::alignment
{
/// Measures how part b, placed by T_a_b, fits part a: over all directions both ways, with `few` points each or many.
PairQuality measurePair(const Part& a, const Part& b, const Eigen::Isometry3f& T_a_b, bool many);

/// Share of the points of b that lie on a.
double coarseOverlap(const Part& a, const Part& b, const Eigen::Isometry3f& T_a_b);

/// What each figure adds to the logarithmic odds of an alignment being right; docs/alignment.md tells from what the
/// weights were learnt.
struct Evidence
{
  double prior = 0, overlap = 0, space = 0, fit = 0, contact = 0, color = 0;
  double light = 0;         ///< what the colours take away too much because the light differs
  double strong_color = 0;  ///< only between poses of the same two parts
  double logit() const { return prior + overlap + space + fit + contact + color + light; }
  /// To tell poses of the same two parts apart. All are under the same two lights, which make up for less of the
  /// differences in the right pose than in one that has the sides of a many-coloured thing confused.
  double score() const { return logit() - light + strong_color; }
};

Evidence evidenceOf(const PairQuality& quality);

}  // namespace object_modelling::alignment
