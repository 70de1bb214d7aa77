#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Geometry>

#include "object_modelling/registration/matched_surface.h"

namespace object_modelling::alignment
{
/// What the motion from one pose of a pair to another does to the surface that both sessions saw. If it brings all of
/// it onto itself, in shape and texture, both poses make the same object.
struct ObjectDifference
{
  double stray_ratio = 0;     ///< of the points of one session, those moved to where views saw that nothing is
  double unknown_ratio = 0;   ///< of all points: those moved to space that no view observed
  double color_variance = 0;  ///< mean square of the differences of the colours of points that meet
  /// Of the points of one session that meet any, those whose colours differ by more than those of the sessions do at
  /// the best pose.
  double other_texture_ratio = 0;
};

/// Compares poses of a pair with its best one. The parts must outlive it. Thread safe.
class PoseComparison
{
public:
  PoseComparison(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                 const Eigen::Isometry3f& T_a_b_best);

  /// Over all points of both sessions, moved forward and back; of strays and of other texture the larger share of the
  /// two.
  ObjectDifference differenceOf(const Eigen::Isometry3f& T_a_b_rival) const;

private:
  const registration::MatchedSurface &a_, &b_;
  Eigen::Isometry3f T_a_b_best_;
  float color_noise_;  ///< what the colours of one place differ by between the sessions, at most
};

/// What speaks against two poses making the same object, each on a scale on which it adds up.
enum class DifferenceFeature
{
  STRAY,    ///< logarithm of the share of strays
  TEXTURE,  ///< logarithm of the colours' difference
  RIVALRY   ///< by how much the log odds of the rival are below those of the best: what is the same scores alike
};
constexpr std::size_t DIFFERENCE_FEATURE_COUNT = 3;
constexpr double MAX_RIVALRY = 7;  ///< of log odds: further below the best one, a pose hardly counts
using DifferenceFeatures = std::array<double, DIFFERENCE_FEATURE_COUNT>;

/// "stray", "texture" or "rivalry".
const char* nameOf(DifferenceFeature feature);

/// `log_odds_gap`: of the best pose minus the rival.
DifferenceFeatures featuresOf(const ObjectDifference& difference, double log_odds_gap);

/// Upper bound of unknown_ratio: beyond it the two poses cannot be compared.
constexpr double MAX_UNKNOWN_RATIO = 0.15;
/// Upper bound of the share of points that meet other texture: beyond it the poses make different objects, however
/// alike they score. Texture that one session alone observed does not count. 0.05 is noise.
constexpr double MAX_OTHER_TEXTURE_RATIO = 0.25;

/// Probability that the rival makes the same object as the best pose, given that the best one is right
/// (docs/alignment.md: how its weights were fitted); 0 beyond MAX_UNKNOWN_RATIO and MAX_OTHER_TEXTURE_RATIO. A gap
/// below 0 or beyond MAX_RIVALRY counts as that.
double sameObjectProbability(const ObjectDifference& difference, double log_odds_gap);

}  // namespace object_modelling::alignment
