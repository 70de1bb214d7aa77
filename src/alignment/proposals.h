#pragma once

#include <cstdint>
#include <vector>

#include "object_modelling/alignment/pair_alignment.h"
#include "object_modelling/registration/point_matches.h"

namespace object_modelling::alignment
{
struct Proposal
{
  ProposalKind kind = ProposalKind::SHAPE;
  Eigen::Isometry3f T_a_b = Eigen::Isometry3f::Identity();
};

/// Poses by three matches of local features that agree (SIFT on the object in both parts' views), each found from a
/// seeded sample and upheld by others.
std::vector<Proposal> proposeByFeatures(const registration::PartPair& pair, std::uint64_t seed);

/// Faces of b's convex hull, merged, that it can stand on, brought onto a's support plane, at rotations about its
/// normal; and the other way round.
std::vector<Proposal> proposeByStablePlanes(const registration::MatchedSurface& a,
                                            const registration::MatchedSurface& b);

/// Rotations evenly over all of them (Alexa: Super-Fibonacci Spirals, CVPR 2022), the centres of the boxes brought
/// together: for shapes without faces or texture.
std::vector<Proposal> proposeByShape(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                                     int rotations);

}  // namespace object_modelling::alignment
