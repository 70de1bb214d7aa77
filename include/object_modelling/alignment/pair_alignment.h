#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "object_modelling/alignment/partial_model.h"

namespace object_modelling::alignment
{
struct PairAlignmentOptions
{
  int rotations = 3000;             ///< tried evenly over all of them, besides those that features and faces propose
  int refined_candidates = 40;      ///< best ones that are refined finely; up to four times as many if they score alike
  double min_overlap_ratio = 0.12;  ///< of the surface of the smaller part
  double min_probability = 0.57;    ///< below it an alignment is refused
  std::uint64_t seed = 1;           ///< of the choice of feature samples
  int threads = 2;                  ///< any number gives the same bits
  std::vector<std::string> violations() const;
};

/// How well two parts fit, both ways.
struct PairQuality
{
  double overlap_ratio = 0;    ///< share of the smaller part's surface that the other part has too
  double fsv_ratio = 0;        ///< free-space violation: front / (front + same), points that views look through or see
  double rmse_m = 0;           ///< point to plane, over the overlap
  double contact_gap_m = 0;    ///< how far the lowest points are off the support plane of the other session; the larger
  double color_agreement = 0;  ///< [-1, 1] correlation over the overlap; 0 without texture
  double texture = 0;          ///< standard deviation of the colours of the overlap: what the agreement is worth
  double light_variance = 0;   ///< of the differences of colours, as much as light from elsewhere explains
  double probability = 0;      ///< of being right, by weights from simulated pairs (docs/alignment.md)
};

/// Where a proposal came from.
enum class ProposalKind
{
  FEATURES,
  STABLE_PLANE,
  SHAPE,
  BY_HAND  ///< a person showed points
};

/// "features", "stable_plane", "shape" or "by_hand".
std::string nameOf(ProposalKind kind);

struct PairCandidate
{
  ProposalKind kind = ProposalKind::SHAPE;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  PairQuality quality;
};

struct PairAlignment
{
  bool accepted = false;
  std::string reason;                     ///< why not
  std::vector<PairCandidate> candidates;  ///< distinct ones, best first; the first is the one accepted
};

/// Pose of part b in the session frame of part a, or why there is none. Deterministic.
PairAlignment alignPair(const PartialModel& a, const PartialModel& b, const PairAlignmentOptions& options,
                        base::JobControl& control);

}  // namespace object_modelling::alignment
