#include "object_modelling/alignment/pair_alignment.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/alignment/pair_evidence.h"
#include "object_modelling/base/options.h"
#include "object_modelling/registration/pair_refinement.h"
#include "object_modelling/registration/support_contact.h"
#include "pair_decision.h"
#include "part_alignment.h"
#include "proposals.h"

namespace object_modelling::alignment
{
namespace
{
/// What is left at most, and at least, after each sieve; between them stay those whose score is close to the best: for
/// round objects all, since colours are compared later only.
struct Sieve
{
  std::size_t least, most;
  double margin;  ///< below the best score
};
constexpr Sieve TO_MEASURE{ 400, 2000, 0.1 };  // of the overlap
constexpr double REFINED_MARGIN = 2;           // of the log odds
constexpr int MOST_REFINED_FACTOR = 4;
constexpr float COARSE_GATE_RATIO = 0.2F;      // of the part's radius
constexpr float MAX_COARSE_GAP_RATIO = 0.12F;  // of the part's radius off the support plane
constexpr float SAME_ROTATION_RAD = 0.05F, SAME_POSITION_RATIO = 0.04F;
constexpr float DISTINCT_ROTATION_RAD = 0.1F, DISTINCT_POSITION_RATIO = 0.08F;

struct Candidate
{
  Proposal proposal;
  double score = 0;
  registration::PairQuality quality;
};

bool same(const Eigen::Isometry3f& x, const Eigen::Isometry3f& y, const registration::MatchedSurface& b,
          float rotation_rad, float ratio)
{
  const Eigen::Isometry3f off = x.inverse() * y;
  // cos(angle) from the trace
  return (off.linear().trace() - 1) / 2 > std::cos(rotation_rad) &&
         (off * b.center - b.center).norm() < ratio * b.radius_m;
}

/// The best of each group of nearly equal poses, best first.
std::vector<Candidate> distinctBest(std::vector<Candidate> candidates, const registration::MatchedSurface& b,
                                    float rotation_rad, float ratio, const Sieve& sieve)
{
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.score > y.score; });
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates)
  {
    const bool alike = kept.empty() || candidate.score > kept.front().score - sieve.margin;
    if (kept.size() >= (alike ? sieve.most : sieve.least))
      break;
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Candidate& other)
                     { return same(candidate.proposal.T_a_b, other.proposal.T_a_b, b, rotation_rad, ratio); }))
      kept.push_back(candidate);
  }
  return kept;
}

/// All proposals, each moved into place by the shape alone, and how much of b then lies on a.
std::vector<Candidate> coarse(const registration::PartPair& pair, const PairAlignmentOptions& options)
{
  const registration::MatchedSurface &a = pair.a, &b = pair.b;
  std::vector<Proposal> proposals = proposeByFeatures(pair, options.seed);
  for (const Proposal& proposal : proposeByStablePlanes(a, b))
    proposals.push_back(proposal);
  for (const Proposal& proposal : proposeByShape(a, b, options.rotations))
    proposals.push_back(proposal);
  std::vector<Candidate> candidates(proposals.size());
  registration::PairIcpOptions icp;
  icp.gate_m = COARSE_GATE_RATIO * a.radius_m;
  icp.last_gate_m = 0.3 * icp.gate_m;
#pragma omp parallel for schedule(dynamic, 16) num_threads(options.threads)
  for (int i = 0; i < static_cast<int>(proposals.size()); ++i)
  {
    Proposal& proposal = proposals[i];
    if (proposal.kind != ProposalKind::FEATURES)
      proposal.T_a_b = registration::alignByIcp(a, b, proposal.T_a_b, icp);
    const bool stands = registration::contactGap_m(a, b, proposal.T_a_b) < MAX_COARSE_GAP_RATIO * a.radius_m;
    candidates[i] = { proposal, stands ? registration::coarseOverlap(a, b, proposal.T_a_b) : 0, {} };
  }
  candidates.erase(
      std::remove_if(candidates.begin(), candidates.end(),
                     [&](const Candidate& candidate) { return candidate.score < options.min_overlap_ratio / 2; }),
      candidates.end());
  return candidates;
}

/// Measured; by `many` points, moved by shape and colour first.
void refine(const registration::PartPair& pair, bool many, const PairAlignmentOptions& options,
            std::vector<Candidate>* candidates)
{
#pragma omp parallel for schedule(dynamic) num_threads(options.threads)
  for (int i = 0; i < static_cast<int>(candidates->size()); ++i)
  {
    Candidate& candidate = (*candidates)[i];
    Eigen::Isometry3f& T = candidate.proposal.T_a_b;
    candidate.quality = many ? registration::refinePairPose(pair, &T) : registration::measurePair(pair, T, false);
    candidate.score = logOdds(candidate.quality, options.same_pose_probability);
  }
}
/// Refines the candidates finely, keeps those that differ, and decides.
PairAlignment decided(const registration::PartPair& pair, const PairAlignmentOptions& options,
                      std::vector<Candidate> candidates, base::JobControl& control)
{
  control.checkCancelled();
  refine(pair, true, options, &candidates);
  candidates = distinctBest(candidates, pair.b, DISTINCT_ROTATION_RAD, DISTINCT_POSITION_RATIO,
                            { candidates.size(), candidates.size(), 0 });
  control.checkCancelled();
  PairAlignment result;
  for (const Candidate& candidate : candidates)
    result.candidates.push_back(
        { candidate.proposal.kind, candidate.proposal.T_a_b.cast<double>(), candidate.quality });
  decide(pair.a, pair.b, options, &result);
  return result;
}
}  // namespace

std::string nameOf(ProposalKind kind)
{
  switch (kind)
  {
    case ProposalKind::FEATURES:
      return "features";
    case ProposalKind::STABLE_PLANE:
      return "stable_plane";
    case ProposalKind::BY_HAND:
      return "by_hand";
    case ProposalKind::CYCLE:
      return "cycle";
    case ProposalKind::SHAPE:
      break;
  }
  return "shape";
}

std::vector<std::string> PairAlignmentOptions::violations() const
{
  base::OptionsCheck check("pair_alignment");
  check.inRange("rotations", rotations, 0, 1000000);
  check.inRange("refined_candidates", refined_candidates, 1, 10000);
  check.inRange("min_overlap_ratio", min_overlap_ratio, 0.0, 1.0);
  check.inRange("min_probability", min_probability, 0.0, 1.0);
  check.inRange("same_pose_probability", same_pose_probability, 0.0, 1.0);
  check.atLeast("threads", threads, 1);
  return check.violations();
}

PairAlignment alignPair(const registration::PartialModel& a, const registration::PartialModel& b,
                        const PairAlignmentOptions& options, base::JobControl& control)
{
  base::checked(options);
  control.checkCancelled();
  return alignParts(registration::MatchedSurface(a, options.threads), registration::MatchedSurface(b, options.threads),
                    options, control);
}

PairAlignment alignParts(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                         const PairAlignmentOptions& options, base::JobControl& control)
{
  control.checkCancelled();
  if (a.fine_samples.empty() || b.fine_samples.empty())
  {
    PairAlignment nothing;
    nothing.reason = "one of the sessions shows no point of the object: select the object, and record it from nearer";
    return nothing;
  }
  const registration::PartPair pair(a, b, options.threads);
  std::vector<Candidate> candidates =
      distinctBest(coarse(pair, options), b, SAME_ROTATION_RAD, SAME_POSITION_RATIO, TO_MEASURE);
  control.checkCancelled();
  refine(pair, false, options, &candidates);
  const auto refined = static_cast<std::size_t>(options.refined_candidates);
  candidates = distinctBest(candidates, b, SAME_ROTATION_RAD, SAME_POSITION_RATIO,
                            { refined, MOST_REFINED_FACTOR * refined, REFINED_MARGIN });
  return decided(pair, options, std::move(candidates), control);
}

PairAlignment alsoAt(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                     const std::vector<PairCandidate>& known, const std::vector<Eigen::Isometry3d>& implied,
                     const PairAlignmentOptions& options, base::JobControl& control)
{
  PairAlignment result;
  result.candidates = known;
  control.checkCancelled();
  if (a.fine_samples.empty() || b.fine_samples.empty())
    return result;
  std::vector<Candidate> added;
  for (const Eigen::Isometry3d& T_a_b : implied)
    added.push_back({ { ProposalKind::CYCLE, T_a_b.cast<float>() }, 0, {} });
  refine(registration::PartPair(a, b, options.threads), true, options, &added);
  for (const Candidate& candidate : added)
  {
    const Eigen::Isometry3f& T_a_b = candidate.proposal.T_a_b;
    if (std::none_of(result.candidates.begin(), result.candidates.end(),
                     [&](const PairCandidate& other)
                     { return same(other.T_a_b.cast<float>(), T_a_b, b, SAME_ROTATION_RAD, SAME_POSITION_RATIO); }))
      result.candidates.push_back({ candidate.proposal.kind, T_a_b.cast<double>(), candidate.quality });
  }
  const auto log_odds = [&](const PairCandidate& candidate)
  { return logOdds(candidate.quality, options.same_pose_probability); };
  std::stable_sort(result.candidates.begin(), result.candidates.end(),
                   [&](const PairCandidate& x, const PairCandidate& y) { return log_odds(x) > log_odds(y); });
  decide(a, b, options, &result);
  return result;
}

std::optional<PairAlignment> confirmParts(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                                          const std::vector<PairCandidate>& known, const PairAlignmentOptions& options,
                                          base::JobControl& control)
{
  if (known.empty() || a.fine_samples.empty() || b.fine_samples.empty())
    return std::nullopt;
  std::vector<Candidate> candidates;
  for (const PairCandidate& candidate : known)
    candidates.push_back({ { candidate.kind, candidate.T_a_b.cast<float>() }, 0, {} });
  PairAlignment again = decided(registration::PartPair(a, b, options.threads), options, std::move(candidates), control);
  if (!again.accepted || !same(again.candidates.front().T_a_b.cast<float>(), known.front().T_a_b.cast<float>(), b,
                               DISTINCT_ROTATION_RAD, DISTINCT_POSITION_RATIO))
    return std::nullopt;
  return again;
}

}  // namespace object_modelling::alignment
