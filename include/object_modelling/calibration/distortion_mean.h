#pragma once

#include <vector>

#include "object_modelling/rgbd/distortion_grid.h"

namespace object_modelling::calibration
{
/// Distortion of a sensor's depth as one recording tells it.
struct DistortionEstimate
{
  rgbd::DistortionGrid::Ratios ratio{};
  rgbd::DistortionGrid::Ratios sigma_ratio{};  ///< a knot whose sigma is not finite and positive does not count
};

struct DistortionMean
{
  rgbd::DistortionGrid::Ratios ratio{};
  double size_ratio = 0;          ///< RMS of what the recordings tell, the more certain knots counting more
  double disagreement_ratio = 0;  ///< RMS of what each tells minus the mean of the others, likewise; 0 if there is none
  /// The others foretell what a recording tells, to half at least. Never so of one recording alone: what is wrong with
  /// its poses looks like distortion too.
  bool agrees = false;
};

/// Mean of the estimates, each knot weighted by its inverse variance. By the same weights it is 0 on the mean of all
/// knots: nothing tells the scale of everything, which stays as it was.
DistortionMean meanDistortion(const std::vector<DistortionEstimate>& estimates);

}  // namespace object_modelling::calibration
