#pragma once

#include <vector>

#include "object_modelling/rgbd/distortion_grid.h"

namespace object_modelling::calibration
{
/// Distortion of a sensor's depth as estimated from one recording.
struct DistortionEstimate
{
  rgbd::DistortionGrid::Ratios ratio{};
  rgbd::DistortionGrid::Ratios sigma_ratio{};  ///< a knot whose sigma is not finite and positive does not count
};

struct DistortionMean
{
  rgbd::DistortionGrid::Ratios ratio{};
  double size_ratio = 0;          ///< RMS of the recordings' estimates, knots weighted by their certainty
  double disagreement_ratio = 0;  ///< RMS of each estimate minus the mean of the others, likewise; 0 for one
  /// The mean of the others predicts at least half of each estimate. Never true of a single recording: errors of its
  /// poses look like distortion too.
  bool agrees = false;
};

/// Mean of the estimates, each knot weighted by its inverse variance. By the same weights it is 0 on the mean of all
/// knots: the overall scale is not determined and stays as it was.
DistortionMean meanDistortion(const std::vector<DistortionEstimate>& estimates);

}  // namespace object_modelling::calibration
