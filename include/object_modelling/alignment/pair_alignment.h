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
  double min_probability = 0.7;     ///< below it an alignment is refused
  /// How often an object is recorded again without having been turned over. A pose that says so has that against it,
  /// for nothing joins two sessions so well as laying one top on the other's; below 0.1 it is found, but not taken
  /// unasked.
  double same_pose_probability = 0.01;
  std::uint64_t seed = 1;  ///< of the choice of feature samples
  int threads = 2;         ///< any number gives the same bits
  std::vector<std::string> violations() const;
};

/// How well two parts fit, both ways.
struct PairQuality
{
  double overlap_ratio = 0;    ///< share of the smaller part's surface that the other part has too
  double fsv_ratio = 0;        ///< free-space violation: front / (front + same), points that views look through or see
  double rmse_m = 0;           ///< point to plane, over the overlap
  double contact_gap_m = 0;    ///< how far the lowest points are off the support plane of the other session; the larger
  double foot_m = 0;           ///< how far the parts end above their own support planes; the larger
  double turn_rad = -1;        ///< by how much the object was turned over between the sessions; negative: not known
  double roughness_m = 0;      ///< of the two surfaces by themselves, over some points; both together
  double color_agreement = 0;  ///< [-1, 1] correlation over the overlap; 0 without texture
  double texture = 0;          ///< standard deviation of the colours of the overlap: what the agreement is worth
  double light_variance = 0;   ///< of the differences of colours, as much as light from elsewhere explains
  double edge_agreement = 0;  ///< [-1, 1] correlation of the slopes of the colours: light that is elsewhere leaves them
  double edge_strength = 0;   ///< standard deviation of those slopes, as colour over the distance they are taken over
  double features_upheld = 0;  ///< matches of local features that the pose brings together
  double probability = 0;      ///< of being right, or one that makes the same object (docs/alignment.md)
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
