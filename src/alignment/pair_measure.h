#pragma once

#include "point_matches.h"

namespace object_modelling::alignment
{
/// Measures how part b, placed by T_a_b, fits part a: over all directions both ways, with `few` points each or many.
PairQuality measurePair(const PartPair& pair, const Eigen::Isometry3f& T_a_b, bool many);

/// Whether most of the views that tell of a point, in their session's frame, look through it.
bool seenThrough(const std::vector<SpaceView>& views, const Eigen::Vector3f& p);

/// Share of the points of b that lie on a.
double coarseOverlap(const Part& a, const Part& b, const Eigen::Isometry3f& T_a_b);

}  // namespace object_modelling::alignment
