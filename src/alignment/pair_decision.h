#pragma once

#include "object_modelling/alignment/pair_alignment.h"
#include "object_modelling/registration/matched_surface.h"

namespace object_modelling::alignment
{
/// Whether two poses of the same two parts fit so much alike that their figures do not decide.
bool scoreAlike(const registration::PairQuality& best, const registration::PairQuality& rival);

/// Accepts the first candidate, or says why not: nothing fits, too little in common, empty space or the support plane
/// violated, or another pose that fits alike and would make another object.
void decide(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
            const PairAlignmentOptions& options, PairAlignment* result);

}  // namespace object_modelling::alignment
