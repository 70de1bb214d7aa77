#pragma once

#include <vector>

#include "object_modelling/registration/matched_surface.h"

namespace object_modelling::registration
{
/// Corresponding points of two parts, in metres, each in its session's frame, matched by local features.
struct PointMatch
{
  Eigen::Vector3f a, b;
};

/// Of every view of a with every view of b: the same point may be matched several times, and most matches may be wrong.
std::vector<PointMatch> matchPoints(const MatchedSurface& a, const MatchedSurface& b, int threads);

/// Two parts and their matches.
struct PartPair
{
  PartPair(const MatchedSurface& given_a, const MatchedSurface& given_b, int threads)
      : a(given_a), b(given_b), matches(matchPoints(given_a, given_b, threads))
  {
  }
  const MatchedSurface &a, &b;
  std::vector<PointMatch> matches;
};

/// Matches that the pose brings nearer than `max_distance_m`.
std::vector<int> upholding(const std::vector<PointMatch>& matches, const Eigen::Isometry3f& T_a_b,
                           float max_distance_m);

}  // namespace object_modelling::registration
