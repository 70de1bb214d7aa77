#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/registration/pair_quality.h"
#include "object_modelling/registration/partial_model.h"

namespace object_modelling::alignment
{
struct PairAlignmentOptions
{
  int rotations = 3000;             ///< tried evenly over all of them, besides those that features and faces propose
  int refined_candidates = 40;      ///< best ones that are refined finely; up to four times as many if they score alike
  double min_overlap_ratio = 0.12;  ///< of the surface of the smaller part
  double min_probability = 0.85;    ///< below it an alignment is refused
  /// Prior probability, in (0, 1), that an object is recorded again without having been turned over. Poses without a
  /// turn are weighted by it, since laying one session's top on the other's always fits well. Below 0.1 such a pose is
  /// found, but not accepted automatically.
  double same_pose_probability = 0.01;
  std::uint64_t seed = 1;  ///< of the choice of feature samples
  int threads = 2;         ///< any number gives the same bits
  std::vector<std::string> violations() const;
};

/// Where a proposal came from.
enum class ProposalKind
{
  FEATURES,
  STABLE_PLANE,
  SHAPE,
  BY_HAND,  ///< a person showed points
  CYCLE     ///< the best poses of two other pairs imply it
};

/// "features", "stable_plane", "shape", "by_hand" or "cycle".
std::string nameOf(ProposalKind kind);

struct PairCandidate
{
  ProposalKind kind = ProposalKind::SHAPE;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  registration::PairQuality quality;
  /// That it makes the same object as the pair's leading pose, which was first when the pair was judged and has 1.
  /// Whoever puts another first leaves that as it is. 0: not known, or another object.
  double same_object_probability = 0;
};

struct PairAlignment
{
  bool accepted = false;
  std::string reason;                     ///< why not
  std::vector<PairCandidate> candidates;  ///< distinct ones, best first; the first is the one accepted
};

/// Pose of part b in the session frame of part a, or why there is none. Deterministic.
PairAlignment alignPair(const registration::PartialModel& a, const registration::PartialModel& b,
                        const PairAlignmentOptions& options, base::JobControl& control);

}  // namespace object_modelling::alignment
