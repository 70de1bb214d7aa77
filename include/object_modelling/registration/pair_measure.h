#pragma once

#include "object_modelling/registration/pair_quality.h"
#include "object_modelling/registration/point_matches.h"

namespace object_modelling::registration
{
/// Measures how part b, placed by T_a_b, fits part a: over all directions both ways, with coarse samples of each or
/// fine ones.
PairQuality measurePair(const PartPair& pair, const Eigen::Isometry3f& T_a_b, bool many);

/// Whether most of the views that observe the place of point p, in their session's frame, see through it.
bool seenThrough(const std::vector<SpaceView>& views, const Eigen::Vector3f& p);

/// Share of the points of b that lie on a.
double coarseOverlap(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b);

}  // namespace object_modelling::registration
