#include "object_modelling/alignment/object_difference.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "difference_weights.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/registration/pair_measure.h"

namespace object_modelling::alignment
{
namespace
{
static_assert(std::size(DIFFERENCE_WEIGHTS) == DIFFERENCE_FEATURE_COUNT);

constexpr double SAME_SHAPE_SPACINGS = 1.5;  // distance of surfaces that are the same
constexpr float SAME_SIDE_COSINE = 0.5F;
constexpr double FREE_STRAY_RATIO = 0.005;    // less is noise
constexpr double MIN_COLOR_VARIANCE = 0.002;  // of colours of one surface, at least
constexpr double NOISE_QUANTILE = 0.95;       // of the differences of the two sessions' colours at the best pose
constexpr float COLOR_NOISE = 0.15F;          // difference of colours that is noise in any case

/// What becomes of the points of one part.
struct Moved
{
  double stray = 0, unknown = 0, met = 0, squares = 0, texture = 0;
};

/// Point of a part that a moved point comes to lie on; -1 if it lies on none.
int metBy(const registration::MatchedSurface& part, const Eigen::Vector3f& p, const Eigen::Vector3f& n, float reach_m)
{
  const int j = part.fine.nearest(p);
  if (j < 0)
    return -1;
  const Eigen::Vector3f off = p - part.model.points[j];
  const bool beside =
      std::abs(part.model.normals[j].dot(off)) <= reach_m && part.model.normals[j].dot(n) > SAME_SIDE_COSINE;
  return beside || off.norm() <= reach_m ? j : -1;
}

float sameReach_m(const registration::MatchedSurface& a, const registration::MatchedSurface& b)
{
  return static_cast<float>(SAME_SHAPE_SPACINGS * std::max(a.model.spacing_m, b.model.spacing_m));
}

/// What the colours of one place differ by between the sessions, at most: more is other texture.
float colorNoise(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                 const Eigen::Isometry3f& T_a_b)
{
  std::vector<float> differences;
  for (const int i : b.fine_samples)
  {
    const int j = metBy(a, T_a_b * b.model.points[i], T_a_b.linear() * b.model.normals[i], sameReach_m(a, b));
    if (j >= 0)
      differences.push_back((a.blurred_colors[j] - b.blurred_colors[i]).norm());
  }
  return std::max(COLOR_NOISE, base::quantile(std::move(differences), NOISE_QUANTILE));
}

/// Moves the points of a part by `T` in its own frame.
Moved move(const registration::MatchedSurface& part, const registration::MatchedSurface& other,
           const Eigen::Isometry3f& T_other_part, const Eigen::Isometry3f& T, float color_noise)
{
  const float reach_m = sameReach_m(part, other);
  Moved result;
  for (const int i : part.fine_samples)
  {
    const Eigen::Vector3f p = T * part.model.points[i], n = T.linear() * part.model.normals[i];
    const Eigen::Vector3f p_other = T_other_part * p;
    const registration::MatchedSurface* met = &part;
    int j = metBy(part, p, n, reach_m);
    if (j < 0)
    {
      met = &other;
      j = metBy(other, p_other, T_other_part.linear() * n, reach_m);
    }
    if (j >= 0)
    {
      result.met += 1;
      const float squared = (met->blurred_colors[j] - part.blurred_colors[i]).squaredNorm();
      result.squares += squared;
      result.texture += squared > color_noise * color_noise;
    }
    else if (registration::seenThrough(part.model.views, p) || registration::seenThrough(other.model.views, p_other))
      result.stray += 1;
    else
      result.unknown += 1;
  }
  return result;
}
}  // namespace

PoseComparison::PoseComparison(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                               const Eigen::Isometry3f& T_a_b_best)
    : a_(a), b_(b), T_a_b_best_(T_a_b_best), color_noise_(colorNoise(a, b, T_a_b_best))
{
}

ObjectDifference PoseComparison::differenceOf(const Eigen::Isometry3f& T_a_b_rival) const
{
  const Eigen::Isometry3f T_b_a_best = T_a_b_best_.inverse(), T_b_a_rival = T_a_b_rival.inverse();
  ObjectDifference result;
  double count = 0, unknown = 0, met = 0, squares = 0;
  const auto add = [&](const registration::MatchedSurface& part, const Moved& forth, const Moved& back)
  {
    const auto all = static_cast<double>(part.fine_samples.size());
    const double met_here = forth.met + back.met;
    count += 2 * all;
    unknown += forth.unknown + back.unknown;
    met += met_here;
    squares += forth.squares + back.squares;
    result.stray_ratio = std::max(result.stray_ratio, std::max(forth.stray, back.stray) / std::max(1.0, all));
    result.other_texture_ratio =
        std::max(result.other_texture_ratio, (forth.texture + back.texture) / std::max(1.0, met_here));
  };
  add(b_, move(b_, a_, T_a_b_best_, T_b_a_best * T_a_b_rival, color_noise_),
      move(b_, a_, T_a_b_best_, T_b_a_rival * T_a_b_best_, color_noise_));
  add(a_, move(a_, b_, T_b_a_best, T_a_b_best_ * T_b_a_rival, color_noise_),
      move(a_, b_, T_b_a_best, T_a_b_rival * T_b_a_best, color_noise_));
  result.unknown_ratio = unknown / std::max(1.0, count);
  result.color_variance = squares / std::max(1.0, met);
  return result;
}

const char* nameOf(DifferenceFeature feature)
{
  switch (feature)
  {
    case DifferenceFeature::STRAY:
      return "stray";
    case DifferenceFeature::TEXTURE:
      return "texture";
    case DifferenceFeature::RIVALRY:
      break;
  }
  return "rivalry";
}

DifferenceFeatures featuresOf(const ObjectDifference& difference, double log_odds_gap)
{
  return { std::log(difference.stray_ratio + FREE_STRAY_RATIO),
           std::log(difference.color_variance + MIN_COLOR_VARIANCE), std::clamp(log_odds_gap, 0.0, MAX_RIVALRY) };
}

double sameObjectProbability(const ObjectDifference& difference, double log_odds_gap)
{
  if (difference.unknown_ratio > MAX_UNKNOWN_RATIO || difference.other_texture_ratio > MAX_OTHER_TEXTURE_RATIO)
    return 0;
  const DifferenceFeatures features = featuresOf(difference, log_odds_gap);
  double log_odds = DIFFERENCE_BIAS;
  for (std::size_t i = 0; i < features.size(); ++i)
    log_odds += DIFFERENCE_WEIGHTS[i] * features[i];
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace object_modelling::alignment
