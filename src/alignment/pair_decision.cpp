#include "pair_decision.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "pair_measure.h"

namespace object_modelling::alignment
{
namespace
{
constexpr double MAX_RIVAL_LOGIT = 1.2;  // nearer to the best than this, poses score alike
// Of two poses of the same two parts, the one where they lie closer is the better by as many logits as patches of the
// surface that err on their own, times the logarithm of the ratio.
constexpr double INDEPENDENT_PATCHES = 4;
constexpr double SAME_SHAPE_SPACINGS = 1.5;  // distance of surfaces that are the same
constexpr double MAX_STRAY_RATIO = 0.04;     // of the points that may be off such a surface
constexpr double SAME_COLOR = 0.15;          // rms difference of colours that are the same, with noise and light

const std::string REMEDY =
    ": if both sessions are of one object, check their masks and support planes, or record more of what they have in "
    "common";

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
std::string whyUnlikely(const PairQuality& quality, const PairAlignmentOptions& options)
{
  if (quality.overlap_ratio < options.min_overlap_ratio)
    return "overlap " + percent(quality.overlap_ratio) + " below " + percent(options.min_overlap_ratio) +
           ": record the object so that more of it is seen in both sessions";
  const Evidence evidence = evidenceOf(quality);
  const double color = evidence.color + evidence.light;
  const double worst = std::min({ evidence.space, evidence.fit, evidence.contact, color });
  if (worst == color)
    return "colours disagree (correlation " + percent(quality.color_agreement) + " over the common surface)" + REMEDY;
  if (worst == evidence.contact)
    return "the object would be " + millimetres(quality.contact_gap_m) + " off what it stood on" + REMEDY;
  if (worst == evidence.space)
    return percent(quality.fsv_ratio) + " of the surface would be where the other session saw that nothing is" + REMEDY;
  return "surfaces are " + millimetres(quality.rmse_m) + " apart" + REMEDY;
}

/// How far a with b placed by `rival` is from making the same object as with b placed by `best`.
struct Difference
{
  double stray_ratio = 0;  ///< of the points of one that are off the other
  double color_rms = 0;
};

/// One way: b placed by `rival` against a with b placed by `best`.
Difference strayOf(const Part& a, const Part& b, const Eigen::Isometry3f& best, const Eigen::Isometry3f& rival)
{
  const auto reach_m = static_cast<float>(SAME_SHAPE_SPACINGS * std::max(a.model.spacing_m, b.model.spacing_m));
  double stray = 0, squares = 0, count = 0;
  const Eigen::Isometry3f T_b_rival = best.inverse() * rival;
  const auto look_up =
      [&](const Part& part, const Eigen::Vector3f& p, const Eigen::Vector3f& n, const Eigen::Vector3f& color)
  {
    const int j = part.fine.nearest(p);
    if (j < 0)
      return false;
    const Eigen::Vector3f off = p - part.model.points[j];
    const bool beside = std::abs(part.model.normals[j].dot(off)) <= reach_m && part.model.normals[j].dot(n) > 0.5F;
    if (!beside && off.norm() > reach_m)
      return false;
    squares += (part.blurred_colors[j] - color).squaredNorm();
    count += 1;
    return true;
  };
  for (const int i : b.many)
  {
    const Eigen::Vector3f& p = b.model.points[i];
    const Eigen::Vector3f& n = b.model.normals[i];
    const Eigen::Vector3f& color = b.blurred_colors[i];
    const bool found =
        look_up(b, T_b_rival * p, T_b_rival.linear() * n, color) || look_up(a, rival * p, rival.linear() * n, color);
    stray += !found;
  }
  return { stray / static_cast<double>(b.many.size()), count > 0 ? std::sqrt(squares / count) : 0 };
}

/// Where the object is symmetric, the one that shows more of it has all that the other shows.
Difference differenceOf(const Part& a, const Part& b, const Eigen::Isometry3f& best, const Eigen::Isometry3f& rival)
{
  const Difference one = strayOf(a, b, best, rival), other = strayOf(a, b, rival, best);
  return { std::min(one.stray_ratio, other.stray_ratio), std::max(one.color_rms, other.color_rms) };
}

double degreesBetween(const Eigen::Isometry3d& x, const Eigen::Isometry3d& y)
{
  return geometry::rotationAngle_rad(x.inverse() * y) * 180 / M_PI;
}
}  // namespace

bool scoreAlike(const PairQuality& best, const PairQuality& rival)
{
  const double closer = std::log(std::max(rival.rmse_m, 1e-6) / std::max(best.rmse_m, 1e-6));
  const double ahead = evidenceOf(best).score() - evidenceOf(rival).score();
  return ahead + INDEPENDENT_PATCHES * std::max(0.0, closer) <= MAX_RIVAL_LOGIT;
}

void decide(const Part& a, const Part& b, const PairAlignmentOptions& options, PairAlignment* result)
{
  result->accepted = false;
  if (result->candidates.empty())
  {
    result->reason = "no pose brings as much as " + percent(options.min_overlap_ratio / 2) +
                     " of the surfaces together with the object on what it stood on" + REMEDY;
    return;
  }
  const PairCandidate& best = result->candidates.front();
  if (best.quality.overlap_ratio < options.min_overlap_ratio || best.quality.probability < options.min_probability)
  {
    result->reason = whyUnlikely(best.quality, options);
    return;
  }
  for (std::size_t i = 1; i < result->candidates.size(); ++i)
  {
    const PairCandidate& rival = result->candidates[i];
    if (!scoreAlike(best.quality, rival.quality))
      continue;
    const Difference difference = differenceOf(a, b, best.T_a_b.cast<float>(), rival.T_a_b.cast<float>());
    const std::string apart = std::to_string(std::lround(degreesBetween(best.T_a_b, rival.T_a_b))) + " deg";
    if (difference.stray_ratio > MAX_STRAY_RATIO)
    {
      result->reason = "two poses " + apart + " apart score alike, and " + percent(difference.stray_ratio) +
                       " of the surface would lie elsewhere: record another view that joins the two";
      return;
    }
    if (difference.color_rms > SAME_COLOR)
    {
      result->reason = "two poses " + apart +
                       " apart score alike: the shape is symmetric, and the texture that both "
                       "sessions saw does not decide";
      return;
    }
  }
  result->accepted = true;
}

}  // namespace object_modelling::alignment
