#pragma once

#include <vector>

#include "bundle_solver.h"

namespace object_modelling::bundle_adjustment
{
/// Pixel error of every sight in sigmas.
std::vector<double> sightErrors_sigmas(const std::vector<rgbd::Keyframe>& keyframes, const BundleState& state);

/// The map without landmarks most of whose sights are off by more than `limit`: a mark on the lens, a reflection, the
/// background of a turntable. They agree among themselves and would tear the keyframes apart while the loss is wide.
LandmarkMap withoutStrays(const LandmarkMap& map, const std::vector<double>& errors, double limit);

/// The map without sights that are off by more than `limit`, and without landmarks of which fewer than `min_sights` are
/// left.
LandmarkMap withoutOutliers(const LandmarkMap& map, const std::vector<double>& errors, double limit, int min_sights);

}  // namespace object_modelling::bundle_adjustment
