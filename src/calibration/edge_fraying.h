#pragma once

#include <map>
#include <vector>

#include "object_modelling/calibration/noise_calibration.h"
#include "object_modelling/rgbd/frame.h"
#include "wall_view.h"

namespace object_modelling::calibration
{
/// How often pixels at a distance from a straight rim of the wall show the wall: a step, frayed by the lateral noise.
struct EdgeProfile
{
  static constexpr int REACH_PX = 8;
  static constexpr int BINS_PER_PX = 4;
  static constexpr int BINS = 2 * REACH_PX * BINS_PER_PX;

  std::vector<double> wall = std::vector<double>(BINS, 0.0), all = std::vector<double>(BINS, 0.0);
  double theta_sum_rad = 0, length_px = 0;
  int edge_count = 0;
};

/// Profiles by angle, in steps of 10 deg.
using EdgeProfiles = std::map<int, EdgeProfile>;

/// Adds the straight rims of the wall that stand before a far background.
void addEdges(const rgbd::Frame& frame, const WallView& view, EdgeProfiles* profiles);

/// Standard deviation of the step, a cumulative normal distribution; 0 if the profile is none.
double frayingSigma_px(const EdgeProfile& profile);

/// Sets the lateral coefficients where there are rims enough; adds to `coefficients`.
void fitLateralSigma(const EdgeProfiles& profiles, const NoiseCalibrationOptions& options,
                     NoiseCalibration* calibration);

}  // namespace object_modelling::calibration
