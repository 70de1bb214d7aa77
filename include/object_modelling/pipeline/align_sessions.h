#pragma once

#include <string>
#include <vector>

#include "object_modelling/alignment/alignment_by_points.h"
#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/alignment/session_part.h"
#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/pipeline/partial_object.h"

// Alignment of stored sessions. What is found for a pair, and what a person decides, is kept in the store: the next
// alignment begins with it. All throw base::Error for store errors.
namespace object_modelling::pipeline
{
struct AlignOptions
{
  alignment::PartialModelOptions part;
  alignment::PairAlignmentOptions pair;
  bool use_known = true;  ///< false: every pair that no person decided is searched anew
  Required required = Required::TWO;
  std::vector<std::string> violations() const;
};

/// Ids of the sessions of one object, oldest first.
std::vector<std::string> sessionsOf(keyframes::SessionStore& store, const std::string& object_id);

/// The object as each session saw it, in this order. FAILED_PRECONDITION for one without keyframes or masks.
std::vector<registration::PartialModel> loadParts(keyframes::SessionStore& store,
                                                  const std::vector<std::string>& session_ids,
                                                  const alignment::PartialModelOptions& options,
                                                  base::JobControl& control);

/// Places the sessions of one object relative to the first that fits another (the model frame is set when the object is
/// built), and stores the result of every pair, refused ones too. A failure to store is reported in the message.
alignment::AlignmentResult alignStoredParts(keyframes::SessionStore& store,
                                            const std::vector<registration::PartialModel>& parts,
                                            const AlignOptions& options, base::JobControl& control);

/// Both. One session needs no alignment, and nothing of it is looked at.
alignment::AlignmentResult alignStoredSessions(keyframes::SessionStore& store,
                                               const std::vector<std::string>& session_ids, const AlignOptions& options,
                                               base::JobControl& control);

/// What is kept of two sessions, in either order; an edge without candidates where nothing is.
alignment::AlignmentEdge knownAlignment(keyframes::SessionStore& store, const std::string& session_a,
                                        const std::string& session_b);

/// A person's decision: this candidate (0: the best) is the pose, whatever its figures. FAILED_PRECONDITION where
/// the pair has not been aligned yet, INVALID_ARGUMENT where it has no such candidate.
alignment::AlignmentEdge acceptAlignment(keyframes::SessionStore& store, const std::string& session_a,
                                         const std::string& session_b, std::size_t candidate);
/// A person's decision: none of the candidates is.
alignment::AlignmentEdge refuseAlignment(keyframes::SessionStore& store, const std::string& session_a,
                                         const std::string& session_b);
/// Takes back what a person decided, and forgets what was found.
void forgetAlignment(keyframes::SessionStore& store, const std::string& session_a, const std::string& session_b);
/// A person's decision: the pose by the points, as the first candidate.
alignment::AlignmentEdge acceptByPoints(keyframes::SessionStore& store, const registration::PartialModel& a,
                                        const registration::PartialModel& b,
                                        const std::vector<alignment::PointPair>& pairs, const AlignOptions& options,
                                        base::JobControl& control);

}  // namespace object_modelling::pipeline
