#pragma once

#include <optional>
#include <vector>

#include "object_modelling/alignment/pair_alignment.h"
#include "object_modelling/registration/matched_surface.h"

namespace object_modelling::alignment
{
/// As alignPair(), of parts that serve for several pairs.
PairAlignment alignParts(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                         const PairAlignmentOptions& options, base::JobControl& control);

/// The poses known from before, best first, moved into place and judged again; nothing if the best of them is not
/// accepted any more, or no longer the best. Costs a tenth of alignParts().
std::optional<PairAlignment> confirmParts(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                                          const std::vector<PairCandidate>& known, const PairAlignmentOptions& options,
                                          base::JobControl& control);

/// A pair that was searched, judged again with poses that other pairs imply, each moved into place. One where the pair
/// has a pose already adds none.
PairAlignment alsoAt(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                     const std::vector<PairCandidate>& known, const std::vector<Eigen::Isometry3d>& implied,
                     const PairAlignmentOptions& options, base::JobControl& control);

}  // namespace object_modelling::alignment
