#pragma once

#include <string>
#include <vector>

#include "../common/store_parameters.h"
#include "object_modelling/base/options.h"
#include "object_modelling/refinement/bundle_adjustment.h"

namespace object_modelling::nodes
{
struct RefinerOptions
{
  refinement::BundleAdjustmentOptions bundle_adjustment;
  ros_bridge::RemoteSessionStoreOptions store;

  std::vector<std::string> violations() const
  {
    base::OptionsCheck check("refiner");
    check.include(bundle_adjustment.violations());
    return check.violations();
  }
};

template <typename Reader>
void read(Reader& reader, RefinerOptions* options)
{
  refinement::BundleAdjustmentOptions& adjustment = options->bundle_adjustment;
  reader.read("bundle_adjustment/pixel_sigma_px", adjustment.pixel_sigma_px);
  reader.read("bundle_adjustment/loss_width_sigmas", adjustment.loss_width_sigmas);
  reader.read("bundle_adjustment/min_observations_per_landmark", adjustment.min_observations_per_landmark);
  reader.read("bundle_adjustment/max_iterations", adjustment.max_iterations);
  reader.read("bundle_adjustment/link_keyframes", adjustment.link_keyframes);
  reader.read("bundle_adjustment/calibrate_color_offset", adjustment.calibrate_color_offset);
  reader.read("bundle_adjustment/calibrate_intrinsics", adjustment.calibrate_intrinsics);
  reader.read("bundle_adjustment/calibrate_depth_ratio", adjustment.calibrate_depth_ratio);
  reader.read("bundle_adjustment/calibrate_depth_offset", adjustment.calibrate_depth_offset);
  reader.read("bundle_adjustment/object_only", adjustment.object_only);
  reader.read("bundle_adjustment/threads", adjustment.threads);
  reader.read("bundle_adjustment/seed", adjustment.seed);
  read(reader, &options->store);
}

}  // namespace object_modelling::nodes
