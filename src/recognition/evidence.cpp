#include "evidence.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::recognition
{
namespace
{
constexpr float TEXTURED = 15;     // contrast in L*a*b* of what counts as textured
constexpr int MOST_FEATURES = 30;  // more say no more
constexpr int MIN_DRAWN_PX = 20;

/// Logarithm of a share's odds, bounded.
float logOdds(float share)
{
  constexpr float LEAST = 0.02F;
  const float bounded = std::clamp(share, 0.F, 1.F);
  return std::log((bounded + LEAST) / (1 - bounded + LEAST));
}

// By test/benchmark/fit_confidence.py (docs/measurements.md, Recognition); in the order of evidenceOf().
constexpr float OFFSET = -24.1379F;
constexpr Evidence WEIGHTS = { 0.4113F,  0.9134F,  -0.0908F, 21.2881F, -3.7406F, 9.7019F,  -4.9862F,
                               -2.7217F, -0.9828F, 1.872F,   1.3603F,  2.4565F,  -4.1325F, -1.3228F };
// Of score, lead, explainedOfVisible() and agreement().
constexpr float CONFIDENCE_OFFSET = -21.71F;
constexpr std::array<float, 4> CONFIDENCE_WEIGHTS = { 1.125F, 0.507F, 22.35F, 4.451F };
constexpr float MOST_LEAD = 5;  // of the score, over the rival's
}  // namespace

float Verification::explainedOfVisible() const
{
  return explained / std::max(visible(), 1e-6F);
}

float Verification::texture() const
{
  return std::min(1.F, contrast / TEXTURED);
}

float Verification::agreement() const
{
  return color_correlation * texture();
}

Evidence evidenceOf(const Verification& v, const PoseHypothesis& hypothesis)
{
  const float agreement = v.agreement();
  const float hue = std::min(2.F, (1 - v.hue_cosine) * std::min(v.chroma_drawn, v.chroma_seen) / 20);
  return { logOdds(v.explainedOfVisible()),
           logOdds(v.normals_agree),
           v.contour,
           std::max(v.edges, 0.6F),
           agreement,
           std::max(0.F, agreement - 0.4F),
           v.texture(),
           hue,
           std::min(v.color_distance, 25.F) / 10,
           std::log10(std::max(1.F, v.visible() * static_cast<float>(v.drawn_px))),
           v.occluded,
           std::log1p(static_cast<float>(std::min(hypothesis.matched_features, MOST_FEATURES))),
           v.flatness * (1 - std::clamp(2 * agreement, 0.F, 1.F)),
           v.unmeasured };
}

float scoreOf(const Verification& verification, const PoseHypothesis& hypothesis)
{
  if (verification.drawn_px < MIN_DRAWN_PX || !(verification.visible() > 0))
    return LEAST_SCORE;
  const Evidence evidence = evidenceOf(verification, hypothesis);
  float score = OFFSET;
  for (std::size_t i = 0; i < evidence.size(); ++i)
    score += WEIGHTS[i] * evidence[i];
  return std::max(score, LEAST_SCORE);
}

float confidenceOf(const Candidate& candidate)
{
  const Verification& v = candidate.verification;
  const std::array<float, 4> values = { candidate.score, std::min(candidate.score - candidate.rival_score, MOST_LEAD),
                                        v.explainedOfVisible(), v.agreement() };
  float log_odds = CONFIDENCE_OFFSET;
  for (std::size_t i = 0; i < values.size(); ++i)
    log_odds += CONFIDENCE_WEIGHTS[i] * values[i];
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace object_modelling::recognition
