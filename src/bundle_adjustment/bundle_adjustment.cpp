#include "object_modelling/bundle_adjustment/bundle_adjustment.h"

#include "adjustment_report.h"
#include "bundle_adjuster.h"
#include "object_modelling/base/options.h"
#include "object_modelling/rgbd/corrected.h"

namespace object_modelling::bundle_adjustment
{
std::vector<std::string> BundleAdjustmentOptions::violations() const
{
  base::OptionsCheck check("bundle_adjustment");
  check.positive("pixel_sigma_px", pixel_sigma_px);
  check.positive("loss_width_sigmas", loss_width_sigmas);
  check.atLeast("min_observations_per_landmark", min_observations_per_landmark, 2);
  check.atLeast("max_iterations", max_iterations, 1);
  check.atLeast("threads", threads, 1);
  return check.violations();
}

BundleAdjustmentResult adjustBundle(const std::vector<rgbd::Keyframe>& keyframes,
                                    const BundleAdjustmentOptions& options, base::JobControl& control)
{
  base::checked(options);
  control.checkCancelled();
  if (!options.calibratesSensor())
    return reportOf(keyframes, options, BundleAdjuster(keyframes, options, &control).run());
  const rgbd::SensorCorrection sensor = BundleAdjuster(keyframes, options, &control).calibrate();
  std::vector<rgbd::Keyframe> right = keyframes;
  for (rgbd::Keyframe& keyframe : right)
    keyframe = rgbd::corrected(keyframe, sensor);
  BundleAdjustmentOptions rest = options;
  rest.calibrate_intrinsics = rest.calibrate_depth_ratio = rest.calibrate_depth_offset = false;
  rest.calibrate_depth_distortion = false;
  BundleAdjustmentResult result = reportOf(right, rest, BundleAdjuster(right, rest, &control).run());
  result.sensor = sensor;
  return result;
}

}  // namespace object_modelling::bundle_adjustment
