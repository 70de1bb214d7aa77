#pragma once

#include <string>
#include <vector>

#include "object_modelling/source/trajectory_file.h"
#include "tracking_run.h"

namespace object_modelling::benchmark_tracking
{
struct Refined
{
  std::vector<source::StampedPose> trajectory;
  double wall_s = 0,
         cpu_s = 0;  ///< of the bundle adjustment with its links, the store's part in it, and the correction
  std::size_t links = 0;
  std::string problem;  ///< why there is no trajectory; empty when there is one
};

/// Refines the keyframes of a run and carries that over to all its frames, as "object_modelling track
/// --refined-trajectory" does: through a keyframe store, with its rounding.
Refined refineRun(const Run& run, const RunOptions& options);

}  // namespace object_modelling::benchmark_tracking
