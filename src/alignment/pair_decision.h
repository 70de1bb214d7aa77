#pragma once

#include "surface_pair.h"

namespace object_modelling::alignment
{
/// Whether two poses of the same two parts fit so much alike that their figures do not decide.
bool scoreAlike(const PairQuality& best, const PairQuality& rival);

/// Accepts the first candidate, or says why not: nothing fits, too little in common, empty space or the support plane
/// violated, or another pose that fits alike and would make another object.
void decide(const Part& a, const Part& b, const PairAlignmentOptions& options, PairAlignment* result);

}  // namespace object_modelling::alignment
