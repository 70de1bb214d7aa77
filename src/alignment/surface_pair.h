#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "object_modelling/alignment/pair_alignment.h"
#include "surface_field.h"

namespace object_modelling::alignment
{
/// Slope of the colours along the surface at a point: one row per channel, per metre.
using ColorGradient = Eigen::Matrix3f;

/// One part of a pair, with what is looked up in it again and again. The partial model must outlive it.
struct Part
{
  Part(const PartialModel& given, int threads);

  const PartialModel& model;
  Eigen::Vector3f centre;
  float radius_m;
  SurfaceField coarse;  ///< far reaching
  SurfaceField fine;
  /// Colours averaged over a neighbourhood of several points and of few, and their slopes.
  std::vector<Eigen::Vector3f> blurred_colors, colors;
  std::vector<ColorGradient> blurred_gradients, gradients;
  std::vector<int> few, many;  ///< points that stand for all, evenly
  double slope_length_m;       ///< that the blurred colours and their slopes are taken over
  double roughness_m;          ///< distance of points from the plane through their neighbours, median
  double foot_m = 0;           ///< how far the lowest points are above the part's own support plane
};

/// As alignPair(), of parts that serve for several pairs.
PairAlignment alignParts(const Part& a, const Part& b, const PairAlignmentOptions& options, base::JobControl& control);

/// The poses known from before, best first, moved into place and judged again; nothing if the best of them is not
/// accepted any more, or no longer the best. Costs a tenth of alignParts().
std::optional<PairAlignment> confirmParts(const Part& a, const Part& b, const std::vector<PairCandidate>& known,
                                          const PairAlignmentOptions& options, base::JobControl& control);

}  // namespace object_modelling::alignment
