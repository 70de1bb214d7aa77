#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/source/trajectory_file.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling::benchmark_tracking
{
struct RunOptions
{
  bool object_reference = false;
  std::uint64_t seed = 1;
  int every = 1;                ///< only every Nth frame
  int skip = 0;                 ///< first frames left out
  bool keep_keyframes = false;  ///< for refining
  rgbd::SensorNoiseModel noise_model;
  double keyframe_angle_rad = 0;  ///< instead of the tracker's; 0: as that has it
};

/// Result of tracking one frame, without its images, and its time.
struct FrameRecord
{
  double wall_ms = 0, cpu_ms = 0;  ///< of the tracker alone: no reading, no rectification
  tracking::TrackingResult result;
  bool keyframe = false;
};

struct Run
{
  std::vector<FrameRecord> frames;
  std::vector<rgbd::Keyframe> keyframes;  ///< if asked for
  int unusable = 0;                       ///< frames that the frame builder refused; among `frames` as not tracked
  double rss_mb = 0, peak_rss_mb = 0;     ///< resident memory of the process at the end, and its peak during the run

  std::vector<source::StampedPose> trajectory() const;
};

/// Tracks a TUM-style folder. Throws base::Error.
Run trackRecording(const std::string& folder, const RunOptions& options);

/// Time since some fixed point, of the clock and of this process's threads.
double wallTime_ms();
double cpuTime_ms();

/// Largest resident memory of the process since resetPeakMemory() (proc(5), clear_refs).
double peakMemory_mb();
void resetPeakMemory();

}  // namespace object_modelling::benchmark_tracking
