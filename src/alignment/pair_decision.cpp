#include "pair_decision.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "object_modelling/alignment/object_difference.h"
#include "object_modelling/alignment/pair_evidence.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::alignment
{
namespace
{
constexpr double MIN_RIVAL_SHARE = 1e-3;   // of the best one's odds: less does not change a probability
constexpr double PLAIN = 0.05;             // deviation of the colours of a surface that has no texture to speak of
constexpr double MAX_STRAY_RATIO = 0.04;   // of the points where nothing is: another shape
constexpr double HARDLY_AGAINST = -1;      // what a figure takes off the log odds, to be named as the reason
constexpr double MAX_LOG_ODDS = 500;       // exponents beyond overflow
constexpr double MAX_FSV_RATIO = 0.05;     // of the surface; right poses of the fitted and calibrated objects: 0.03
constexpr double JOINED = 0.5;             // probability of making the same object, beyond which one is spoken of
constexpr double ASKED_PROBABILITY = 0.1;  // of the same pose: below it no such pose is taken unasked

const std::string REMEDY =
    ": if both sessions are of one object, check their masks and support planes, or record more of what they have in "
    "common";

const std::string IN_EMPTY_SPACE = " of the surface would be where the other session saw that nothing is" + REMEDY;

const std::string NOT_TURNED =
    "the two fit best as if the object had not been turned over in between: turn it over and record again, or, if it "
    "lay as before, accept that pose or allow for it (same_pose_probability of the session_aligner, or "
    "--same-pose-probability, 0.5)";

std::string percent(double ratio)
{
  std::ostringstream out;
  out << std::lround(100 * ratio) << " %";
  return out.str();
}

/// Rounded down: what is short of a limit does not look like it.
std::string percentBelow(double ratio)
{
  return percent(std::floor(100 * ratio) / 100);
}

std::string millimeters(double length_m)
{
  std::ostringstream out;
  out.precision(1);
  out << std::fixed << 1000 * length_m << " mm";
  return out.str();
}

/// The figure that speaks most against a candidate.
std::string whyUnlikely(const registration::PairQuality& quality, const PairAlignmentOptions& options)
{
  if (quality.overlap_ratio < options.min_overlap_ratio)
    return "overlap " + percent(quality.overlap_ratio) + " below " + percent(options.min_overlap_ratio) +
           ": record the object so that more of it is seen in both sessions";
  const FeatureVector evidence = contributions(quality);
  const auto of = [&](Feature feature) { return evidence[static_cast<std::size_t>(feature)]; };
  const double color = of(Feature::TEXTURE) + of(Feature::COLOR) + of(Feature::EDGES);
  const double space = of(Feature::SPACE) + of(Feature::THROUGH);
  const double turn = turnPrior(quality, options.same_pose_probability);
  const double worst = std::min({ space, of(Feature::CONTACT), of(Feature::FIT), color, turn });
  if (quality.fsv_ratio > MAX_FSV_RATIO)
    return percent(quality.fsv_ratio) + IN_EMPTY_SPACE;
  if (worst > HARDLY_AGAINST)
    return "the best pose is right with a probability of " + percentBelow(quality.probability) + " only (at least " +
           percent(options.min_probability) +
           " is needed): nothing speaks against it, but too little for it; record more of what both sessions see, or "
           "lean "
           "the object so that a textured face is seen in both";
  if (worst == turn)
    return NOT_TURNED;
  if (worst == color)
    return "colours disagree (correlation " + percent(quality.color_agreement) + " over the common surface)" + REMEDY;
  if (worst == of(Feature::CONTACT))
    return "the object would be " + millimeters(quality.contact_gap_m) + " off what it stood on" + REMEDY;
  if (worst == space)
    return percent(quality.fsv_ratio) + IN_EMPTY_SPACE;
  return "surfaces are " + millimeters(quality.rmse_m) + " apart" + REMEDY;
}

/// Sets the probability of each candidate against all the others and none being right; returns that of any of them.
double weighUp(const PairAlignmentOptions& options, std::vector<PairCandidate>* candidates)
{
  double sum = 0;
  for (PairCandidate& candidate : *candidates)
  {
    candidate.quality.probability =
        std::exp(std::min(logOdds(candidate.quality, options.same_pose_probability), MAX_LOG_ODDS));
    sum += candidate.quality.probability;
  }
  for (PairCandidate& candidate : *candidates)
    candidate.quality.probability /= 1 + sum;
  return sum / (1 + sum);
}

bool refusesAsNotTurned(const registration::PairQuality& quality, const PairAlignmentOptions& options)
{
  return impliesNotTurned(quality) && options.same_pose_probability < ASKED_PROBABILITY;
}

/// A pose against the one that is to be accepted.
struct Compared
{
  std::size_t index = 0;
  ObjectDifference difference;
  double same_object_probability = 0;
};

/// Those poses that matter beside the first one, against it.
std::vector<Compared> compared(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                               const std::vector<PairCandidate>& candidates, const PairAlignmentOptions& options)
{
  const PairCandidate& lead = candidates.front();
  const double lead_log_odds = logOdds(lead.quality, options.same_pose_probability);
  const double least = MIN_RIVAL_SHARE * lead.quality.probability;
  std::vector<Compared> result;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].quality.probability >= least)
      result.push_back({ i, {}, 0 });
  const PoseComparison comparison(a, b, lead.T_a_b.cast<float>());
#pragma omp parallel for schedule(dynamic) num_threads(options.threads)
  for (int k = 0; k < static_cast<int>(result.size()); ++k)
  {
    Compared& other = result[k];
    const PairCandidate& rival = candidates[other.index];
    other.difference = comparison.differenceOf(rival.T_a_b.cast<float>());
    other.same_object_probability =
        sameObjectProbability(other.difference, lead_log_odds - logOdds(rival.quality, options.same_pose_probability));
  }
  return result;
}

/// Probability of a pose if there were no other.
double aloneProbability(const registration::PairQuality& quality, const PairAlignmentOptions& options)
{
  return 1 / (1 + std::exp(-logOdds(quality, options.same_pose_probability)));
}

bool fitsAtAll(const registration::PairQuality& quality, const PairAlignmentOptions& options)
{
  return quality.overlap_ratio >= options.min_overlap_ratio && quality.fsv_ratio <= MAX_FSV_RATIO;
}

/// Puts first the most probable pose at which the object had been turned over, if the first is one at which it had not,
/// both make the same object, and the turned one would be accepted alone. A can, for example, fits best upright.
/// Returns whether there is such a pose; `others` are compared with the former first pose.
bool leadByTurned(const std::vector<Compared>& others, const PairAlignmentOptions& options,
                  std::vector<PairCandidate>* candidates)
{
  if (!refusesAsNotTurned(candidates->front().quality, options))
    return false;
  for (const Compared& other : others)
  {
    const registration::PairQuality& quality = (*candidates)[other.index].quality;
    if (other.same_object_probability <= JOINED || impliesNotTurned(quality) || !fitsAtAll(quality, options) ||
        aloneProbability(quality, options) < options.min_probability)
      continue;
    std::rotate(candidates->begin(), candidates->begin() + static_cast<std::ptrdiff_t>(other.index),
                candidates->begin() + static_cast<std::ptrdiff_t>(other.index) + 1);
    return true;
  }
  return false;
}

/// A pose that other pairs imply was not found by this pair's search. Where it makes the same object as one that was,
/// it is no further evidence for it, and counts once with it only: else every such pose would make the pair more sure.
/// Returns the share that is taken off.
double countImpliedOnce(const std::vector<Compared>& others, std::vector<PairCandidate>* candidates)
{
  double off = 0;
  const auto take = [&](PairCandidate& candidate, double share)
  {
    share = std::min(share, candidate.quality.probability);
    candidate.quality.probability -= share;
    off += share;
  };
  double found = 0;
  for (const Compared& other : others)
  {
    PairCandidate& pose = (*candidates)[other.index];
    const double same = other.same_object_probability * pose.quality.probability;
    if (pose.kind == ProposalKind::CYCLE)
      take(pose, same);
    else
      found += same;
  }
  if (candidates->front().kind == ProposalKind::CYCLE)
    take(candidates->front(), found);
  for (PairCandidate& candidate : *candidates)
    candidate.quality.probability /= 1 - off;
  return off;
}

/// Evidence of the other poses against the best one.
struct Rivals
{
  const PairCandidate* candidate = nullptr;  ///< most probable one that makes another object; null: none to speak of
  ObjectDifference difference;               ///< of that one
  std::size_t same = 0;                      ///< those that probably make the same object
};

/// Any pose that makes the same object as the first one makes that one right too: it counts for the first one by how
/// probably it does, and the first one, with all that it has, for each of them. Sets how probably each does.
Rivals joinEquivalent(const std::vector<Compared>& others, std::vector<PairCandidate>* candidates)
{
  for (PairCandidate& candidate : *candidates)
    candidate.same_object_probability = 0;
  candidates->front().same_object_probability = 1;
  double& together = candidates->front().quality.probability;
  for (const Compared& other : others)
    together += other.same_object_probability * (*candidates)[other.index].quality.probability;
  Rivals rivals;
  for (const Compared& other : others)
  {
    PairCandidate& pose = (*candidates)[other.index];
    pose.same_object_probability = other.same_object_probability;
    double& own = pose.quality.probability;
    if (other.same_object_probability > JOINED)
      ++rivals.same;
    else if (!rivals.candidate)  // they are sorted
    {
      rivals.candidate = &pose;
      rivals.difference = other.difference;
    }
    own += other.same_object_probability * std::max(0.0, together - own);
  }
  return rivals;
}

double degreesBetween(const Eigen::Isometry3d& x, const Eigen::Isometry3d& y)
{
  return geometry::rotationAngle_rad(x.inverse() * y) * 180 / M_PI;
}

/// Why the best pose is not certain although one of two is.
std::string whyAmbiguous(const PairCandidate& best, const PairCandidate& rival, const ObjectDifference& difference)
{
  const std::string two =
      "two poses " + std::to_string(std::lround(degreesBetween(best.T_a_b, rival.T_a_b))) + " deg apart score alike";
  if (difference.stray_ratio > MAX_STRAY_RATIO || difference.unknown_ratio > MAX_UNKNOWN_RATIO)
    return two + ", and " + percent(std::max(difference.stray_ratio, difference.unknown_ratio)) +
           " of the surface would lie elsewhere: record another view that joins the two";
  if (best.quality.texture < PLAIN)
    return two +
           ": the shape is symmetric, and the sides that both sessions see are plain: lean the object so that a "
           "textured face is seen in both";
  return two +
         ": the shape is symmetric, and the texture that both sessions see is alike in both: record the object so "
         "that a side that tells them apart is seen in both";
}

/// Why poses that probably make one object are too improbable together.
std::string whyAlmost(const registration::PairQuality& quality, std::size_t same, const PairAlignmentOptions& options)
{
  return std::to_string(same + 1) + " poses probably make the same object, but are right with a probability of " +
         percentBelow(quality.probability) + " only (at least " + percent(options.min_probability) +
         " is needed): accept the best one if it looks right, or lean the object so that a textured face is seen in "
         "both "
         "sessions";
}
}  // namespace

void decide(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
            const PairAlignmentOptions& options, PairAlignment* result)
{
  result->accepted = false;
  if (result->candidates.empty())
  {
    result->reason = "no pose brings as much as " + percent(options.min_overlap_ratio / 2) +
                     " of the surfaces together with the object on what it stood on" + REMEDY;
    return;
  }
  double any = weighUp(options, &result->candidates);
  std::vector<Compared> others = compared(a, b, result->candidates, options);
  if (leadByTurned(others, options, &result->candidates))
    others = compared(a, b, result->candidates, options);
  const double twice = countImpliedOnce(others, &result->candidates);
  any = (any - twice) / (1 - twice);
  const Rivals rivals = joinEquivalent(others, &result->candidates);
  const PairCandidate& best = result->candidates.front();
  if (!fitsAtAll(best.quality, options))
    result->reason = whyUnlikely(best.quality, options);
  else if (!(best.quality.probability >= options.min_probability))
    result->reason = any < options.min_probability ? whyUnlikely(best.quality, options)
                     : rivals.candidate            ? whyAmbiguous(best, *rivals.candidate, rivals.difference)
                                                   : whyAlmost(best.quality, rivals.same, options);
  else if (refusesAsNotTurned(best.quality, options))
    result->reason = NOT_TURNED;
  else if (!a.model.doubt.empty() || !b.model.doubt.empty())
    result->reason = a.model.doubt.empty() ? b.model.doubt : a.model.doubt;
  else
    result->accepted = true;
}

}  // namespace object_modelling::alignment
