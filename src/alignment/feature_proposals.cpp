#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "object_modelling/base/ransac.h"
#include "object_modelling/geometry/transform.h"
#include "proposals.h"

namespace object_modelling::alignment
{
namespace
{
constexpr float MAX_DISTANCE_M = 0.006F;  // of a feature's point from its partner: depth noise at both
constexpr int SAMPLES = 3000;
constexpr int MIN_UPHOLDING = 6;
constexpr std::size_t MAX_PROPOSALS = 10;
constexpr float MIN_SIDE_RATIO = 0.15F;  // of the part's radius: nearer points hardly constrain rotation

std::optional<Eigen::Isometry3f> poseFrom(const std::vector<registration::PointMatch>& matches,
                                          const std::vector<int>& chosen)
{
  Eigen::Matrix3Xd p_a(3, chosen.size()), p_b(3, chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
  {
    p_a.col(static_cast<Eigen::Index>(i)) = matches[chosen[i]].a.cast<double>();
    p_b.col(static_cast<Eigen::Index>(i)) = matches[chosen[i]].b.cast<double>();
  }
  Eigen::Isometry3d T_a_b;
  if (!geometry::rigidTransformFromPoints(p_a, p_b, &T_a_b))
    return std::nullopt;
  return T_a_b.cast<float>();
}

/// Whether the sides of both triangles are as long.
bool congruent(const registration::PointMatch& x, const registration::PointMatch& y, float min_side_m)
{
  const float side_a = (x.a - y.a).norm(), side_b = (x.b - y.b).norm();
  return side_a > min_side_m && std::abs(side_a - side_b) < MAX_DISTANCE_M;
}
}  // namespace

std::vector<Proposal> proposeByFeatures(const registration::PartPair& pair, std::uint64_t seed)
{
  const registration::MatchedSurface &a = pair.a, &b = pair.b;
  const std::vector<registration::PointMatch>& matches = pair.matches;
  struct Scored
  {
    std::size_t support;
    Eigen::Isometry3f T_a_b;
  };
  std::vector<Scored> found;
  const float min_side_m = MIN_SIDE_RATIO * std::min(a.radius_m, b.radius_m);
  // Every hypothesis that is upheld counts, not only the best.
  base::SampleDraws<3> draws(matches.size(), seed);
  for (int drawn = 0; drawn < SAMPLES; ++drawn)
  {
    const std::optional<std::array<int, 3>> sample = draws.next();
    if (!sample)
      continue;
    const auto& [i, j, k] = *sample;
    if (!congruent(matches[i], matches[j], min_side_m) || !congruent(matches[j], matches[k], min_side_m) ||
        !congruent(matches[k], matches[i], min_side_m))
      continue;
    std::optional<Eigen::Isometry3f> T = poseFrom(matches, { i, j, k });
    if (!T)
      continue;
    const std::vector<int> first = registration::upholding(matches, *T, MAX_DISTANCE_M);
    if (static_cast<int>(first.size()) < MIN_UPHOLDING)
      continue;
    T = poseFrom(matches, first);
    if (T)
      found.push_back({ registration::upholding(matches, *T, MAX_DISTANCE_M).size(), *T });
  }
  std::stable_sort(found.begin(), found.end(), [](const Scored& x, const Scored& y) { return x.support > y.support; });
  std::vector<Proposal> proposals;
  for (const Scored& scored : found)
  {
    const bool known = std::any_of(proposals.begin(), proposals.end(),
                                   [&](const Proposal& other)
                                   {
                                     const Eigen::Isometry3f off = other.T_a_b.inverse() * scored.T_a_b;
                                     return Eigen::AngleAxisf(off.linear()).angle() < 0.1F &&
                                            (off * b.center - b.center).norm() < 0.01F;
                                   });
    if (!known)
      proposals.push_back({ ProposalKind::FEATURES, scored.T_a_b });
    if (proposals.size() >= MAX_PROPOSALS)
      break;
  }
  return proposals;
}

}  // namespace object_modelling::alignment
