#pragma once

#include "object_modelling/alignment/pair_alignment.h"
#include "object_modelling/registration/matched_surface.h"

namespace object_modelling::alignment
{
/// Accepts the first candidate, or refuses it with the reason: nothing fits, too little in common, empty space or the
/// support plane violated, or another pose that fits alike and would make another object. A pose at which the object
/// had been turned over comes first where it makes the same object as one at which it had not.
void decide(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
            const PairAlignmentOptions& options, PairAlignment* result);

}  // namespace object_modelling::alignment
