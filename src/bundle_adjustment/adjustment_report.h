#pragma once

#include "bundle_adjuster.h"

namespace object_modelling::bundle_adjustment
{
/// The result for the caller: new poses with covariance if the adjustment converged, else the old ones and the reason;
/// residuals before and after, over the same sights.
BundleAdjustmentResult reportOf(const std::vector<rgbd::Keyframe>& keyframes, const BundleAdjustmentOptions& options,
                                const Adjustment& adjustment);

}  // namespace object_modelling::bundle_adjustment
