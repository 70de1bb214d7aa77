#pragma once

#include <vector>

#include "object_modelling/registration/partial_model.h"
#include "object_modelling/registration/surface_field.h"

namespace object_modelling::registration
{
/// Slope of the colours along the surface at a point: one row per channel, per metre.
using ColorGradient = Eigen::Matrix3f;

/// One part of a pair, with what is looked up in it again and again. The partial model must outlive it.
struct MatchedSurface
{
  MatchedSurface(const PartialModel& given, int threads);

  const PartialModel& model;
  Eigen::Vector3f center;  ///< session frame, m
  float radius_m;          ///< farthest point from the centre
  SurfaceField coarse;     ///< far reaching
  SurfaceField fine;
  /// Colours averaged over a neighbourhood of several points and of few, and their slopes.
  std::vector<Eigen::Vector3f> blurred_colors, colors;
  std::vector<ColorGradient> blurred_gradients, gradients;
  std::vector<int> coarse_samples, fine_samples;  ///< points that stand for all, evenly
  double slope_length_m;                          ///< that the blurred colours and their slopes are taken over
  double roughness_m;  ///< distance of points from the plane through their neighbours, median
  double foot_m = 0;   ///< how far the lowest points are above the part's own support plane
};

}  // namespace object_modelling::registration
