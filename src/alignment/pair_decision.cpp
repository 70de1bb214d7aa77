#include "pair_decision.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "object_modelling/alignment/pair_evidence.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/registration/pair_measure.h"

namespace object_modelling::alignment
{
namespace
{
constexpr double MAX_RIVAL_LOGIT = 1.2;      // nearer to the best than this, poses score alike
constexpr double MIN_RIVAL_SHARE = 1e-3;     // of the best one's odds: less does not change a probability
constexpr double PLAIN = 0.05;               // deviation of the colours of a surface that has no print to speak of
constexpr double SAME_SHAPE_SPACINGS = 1.5;  // distance of surfaces that are the same
constexpr double MAX_STRAY_RATIO = 0.04;     // of the points that may be where nothing is if such a surface is
constexpr double MAX_UNKNOWN_RATIO = 0.15;   // of those that may be beside it where nobody looked
constexpr double SAME_COLOR = 0.1;           // rms difference of colours that are the same, with noise and light
constexpr double HARDLY_AGAINST = -1;        // what a figure takes off the log odds, to be named as the reason
constexpr double MAX_LOG_ODDS = 500;         // exponents beyond overflow
constexpr float OTHER_COLOR = 0.35F;         // difference of colours that are not the same
constexpr double MAX_PRINT_RATIO = 0.03;     // of the points that may have such
constexpr double MAX_FSV_RATIO = 0.05;       // of the surface; right poses of the fitted and calibrated objects: 0.03
constexpr double ASKED_PROBABILITY = 0.1;    // of the same pose: below it no such pose is taken unasked

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

std::string millimetres(double length_m)
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
  const double color = of(Feature::PRINT) + of(Feature::COLOR) + of(Feature::EDGES);
  const double space = of(Feature::SPACE) + of(Feature::THROUGH);
  const double turn = turnPrior(quality, options.same_pose_probability);
  const double worst = std::min({ space, of(Feature::CONTACT), of(Feature::FIT), color, turn });
  if (quality.fsv_ratio > MAX_FSV_RATIO)
    return percent(quality.fsv_ratio) + IN_EMPTY_SPACE;
  if (worst > HARDLY_AGAINST)
    return "the best pose is right with a probability of " + percent(quality.probability) + " only (at least " +
           percent(options.min_probability) +
           " is needed): nothing speaks against it, but too little for it; record more of what both sessions see, or "
           "lean "
           "the object so that a printed face is seen in both";
  if (worst == turn)
    return NOT_TURNED;
  if (worst == color)
    return "colours disagree (correlation " + percent(quality.color_agreement) + " over the common surface)" + REMEDY;
  if (worst == of(Feature::CONTACT))
    return "the object would be " + millimetres(quality.contact_gap_m) + " off what it stood on" + REMEDY;
  if (worst == space)
    return percent(quality.fsv_ratio) + IN_EMPTY_SPACE;
  return "surfaces are " + millimetres(quality.rmse_m) + " apart" + REMEDY;
}

/// How far a with b placed by `rival` is from making the same object as with b placed by `best`.
struct Difference
{
  double stray_ratio = 0;    ///< of the points of one, where views look through that would not if the other were right
  double unknown_ratio = 0;  ///< of those that are off the other where nobody looked
  double color_rms = 0;
  double print_ratio = 0;  ///< of those found whose colours are clearly others: a label is few of the points

  bool sameShape() const { return stray_ratio <= MAX_STRAY_RATIO && unknown_ratio <= MAX_UNKNOWN_RATIO; }
  bool sameObject() const { return sameShape() && color_rms <= SAME_COLOR && print_ratio <= MAX_PRINT_RATIO; }
};

/// One way: b placed by `rival` against a with b placed by `best`.
Difference strayOf(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                   const Eigen::Isometry3f& best, const Eigen::Isometry3f& rival)
{
  const auto reach_m = static_cast<float>(SAME_SHAPE_SPACINGS * std::max(a.model.spacing_m, b.model.spacing_m));
  double stray = 0, unknown = 0, squares = 0, print = 0, count = 0;
  const Eigen::Isometry3f T_b_rival = best.inverse() * rival;
  const auto look_up = [&](const registration::MatchedSurface& part, const Eigen::Vector3f& p, const Eigen::Vector3f& n,
                           const Eigen::Vector3f& color)
  {
    const int j = part.fine.nearest(p);
    if (j < 0)
      return false;
    const Eigen::Vector3f off = p - part.model.points[j];
    const bool beside = std::abs(part.model.normals[j].dot(off)) <= reach_m && part.model.normals[j].dot(n) > 0.5F;
    if (!beside && off.norm() > reach_m)
      return false;
    const float squared = (part.blurred_colors[j] - color).squaredNorm();
    squares += squared;
    print += squared > OTHER_COLOR * OTHER_COLOR;
    count += 1;
    return true;
  };
  for (const int i : b.fine_samples)
  {
    const Eigen::Vector3f& p = b.model.points[i];
    const Eigen::Vector3f& n = b.model.normals[i];
    const Eigen::Vector3f& color = b.blurred_colors[i];
    const bool found =
        look_up(b, T_b_rival * p, T_b_rival.linear() * n, color) || look_up(a, rival * p, rival.linear() * n, color);
    if (found)
      continue;
    const bool through =
        registration::seenThrough(a.model.views, rival * p) || registration::seenThrough(b.model.views, T_b_rival * p);
    (through ? stray : unknown) += 1;
  }
  const auto all = static_cast<double>(std::max<std::size_t>(1, b.fine_samples.size()));
  const double found = std::max(1.0, count);
  return { stray / all, unknown / all, std::sqrt(squares / found), print / found };
}

/// Where the object is symmetric, the one that shows more of it has all that the other shows.
Difference differenceOf(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                        const Eigen::Isometry3f& best, const Eigen::Isometry3f& rival)
{
  const Difference one = strayOf(a, b, best, rival), other = strayOf(a, b, rival, best);
  return { std::min(one.stray_ratio, other.stray_ratio), std::min(one.unknown_ratio, other.unknown_ratio),
           std::max(one.color_rms, other.color_rms), std::max(one.print_ratio, other.print_ratio) };
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

/// The most probable pose that makes another object than the best one.
struct Rival
{
  const PairCandidate* candidate = nullptr;  ///< null: there is none to speak of
  Difference difference;
};

/// Those that make the same object as the best one have one probability in common, that of all of them.
Rival joinEquivalent(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                     std::vector<PairCandidate>* candidates)
{
  PairCandidate& best = candidates->front();
  double together = best.quality.probability;
  std::vector<PairCandidate*> equivalent = { &best };
  Rival rival;
  for (std::size_t i = 1; i < candidates->size(); ++i)
  {
    PairCandidate& other = (*candidates)[i];
    if (other.quality.probability < MIN_RIVAL_SHARE * best.quality.probability)
      continue;
    const Difference difference = differenceOf(a, b, best.T_a_b.cast<float>(), other.T_a_b.cast<float>());
    if (difference.sameObject())
    {
      together += other.quality.probability;
      equivalent.push_back(&other);
    }
    else if (!rival.candidate || other.quality.probability > rival.candidate->quality.probability)
      rival = { &other, difference };
  }
  for (PairCandidate* pose : equivalent)
    pose->quality.probability = together;
  return rival;
}

double degreesBetween(const Eigen::Isometry3d& x, const Eigen::Isometry3d& y)
{
  return geometry::rotationAngle_rad(x.inverse() * y) * 180 / M_PI;
}

/// Why the best pose is not certain although one of two is.
std::string whyAmbiguous(const PairCandidate& best, const PairCandidate& rival, const Difference& difference)
{
  const std::string two =
      "two poses " + std::to_string(std::lround(degreesBetween(best.T_a_b, rival.T_a_b))) + " deg apart score alike";
  if (!difference.sameShape())
    return two + ", and " + percent(difference.stray_ratio + difference.unknown_ratio) +
           " of the surface would lie elsewhere: record another view that joins the two";
  if (best.quality.texture < PLAIN)
    return two +
           ": the shape is symmetric, and the sides that both sessions see are plain: lean the object so that a "
           "printed face is seen in both";
  return two +
         ": the shape is symmetric, and the print that both sessions see is alike in both: record the object so "
         "that a side that tells them apart is seen in both";
}
}  // namespace

bool scoreAlike(const registration::PairQuality& best, const registration::PairQuality& rival)
{
  return logOdds(best, 0.5) - logOdds(rival, 0.5) <= MAX_RIVAL_LOGIT;
}

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
  const double any = weighUp(options, &result->candidates);
  const Rival rival = joinEquivalent(a, b, &result->candidates);
  const PairCandidate& best = result->candidates.front();
  if (best.quality.overlap_ratio < options.min_overlap_ratio || best.quality.fsv_ratio > MAX_FSV_RATIO)
    result->reason = whyUnlikely(best.quality, options);
  else if (best.quality.probability < options.min_probability)
    result->reason = rival.candidate && any >= options.min_probability
                         ? whyAmbiguous(best, *rival.candidate, rival.difference)
                         : whyUnlikely(best.quality, options);
  else if (saysNotTurned(best.quality) && options.same_pose_probability < ASKED_PROBABILITY)
    result->reason = NOT_TURNED;
  else
    result->accepted = true;
}

}  // namespace object_modelling::alignment
