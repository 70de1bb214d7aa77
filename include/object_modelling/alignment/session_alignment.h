#pragma once

#include <string>
#include <vector>

#include "object_modelling/alignment/pair_alignment.h"

namespace object_modelling::alignment
{
/// Whether a person has decided on a pair. That stands: it is neither found anew nor left out for another pair's sake.
enum class Decision
{
  AUTOMATIC,
  ACCEPTED,
  REFUSED
};

/// "automatic", "accepted" or "refused".
std::string nameOf(Decision decision);

/// What was found for two sessions.
struct AlignmentEdge
{
  std::string session_a, session_b;
  Decision decision = Decision::AUTOMATIC;
  bool accepted = false;
  bool used = false;   ///< a placement rests on it; an accepted one that is not used closed a cycle, or failed to
  std::string reason;  ///< why it was refused, or left out
  /// Distinct poses, best first: p_a = T_a_b p_b. Empty where nothing brought the two together.
  std::vector<PairCandidate> candidates;

  const PairCandidate* best() const { return candidates.empty() ? nullptr : &candidates.front(); }
};

struct SessionPlacement
{
  std::string session_id;
  Eigen::Isometry3d T_reference_session = Eigen::Isometry3d::Identity();  ///< into the reference session's frame
};

struct AlignmentResult
{
  /// OK: all placed, or with a message that names those left out. NO_RESULT: no two sessions could be aligned.
  base::Status status;
  std::vector<SessionPlacement> placements;  ///< the reference session first
  std::vector<std::string> left_out;         ///< sessions that could not be placed
  std::vector<AlignmentEdge> edges;          ///< every pair
};

/// Places the sessions of one object in the frame of the first of them (where that one fits none, of the first that
/// does) by all edges together: a session is placed where it is more probable than `min_probability`, given
/// all its pairs with the others. One that is not is left out and named, never left at identity.
AlignmentResult placeSessions(const std::vector<registration::PartialModel>& parts, double min_probability,
                              std::vector<AlignmentEdge> edges);

/// Aligns every pair of sessions, and places them. Of `known_edges`, those
/// that a person decided stand; an accepted one is taken over, at its pose moved into place, where the parts still
/// bear it out; the rest is found anew. Deterministic.
AlignmentResult alignSessions(const std::vector<registration::PartialModel>& parts,
                              const std::vector<AlignmentEdge>& known_edges, const PairAlignmentOptions& options,
                              base::JobControl& control);

}  // namespace object_modelling::alignment
