#include "tracking_run.h"

#include <chrono>
#include <ctime>
#include <fstream>
#include <memory>

#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/source/tum_folder.h"

namespace object_modelling::benchmark_tracking
{
namespace
{
/// A line "VmRSS:   1234 kB" of the kernel's account of this process.
double processMemory_mb(const std::string& key)
{
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes = 0; word == key + ":" && status >> kilobytes)
      return kilobytes / 1024;
  return 0;
}
}  // namespace

double peakMemory_mb()
{
  return processMemory_mb("VmHWM");
}

void resetPeakMemory()
{
  std::ofstream("/proc/self/clear_refs") << "5";
}

double wallTime_ms()
{
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpuTime_ms()
{
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

std::vector<source::StampedPose> Run::trajectory() const
{
  std::vector<source::StampedPose> poses;
  for (const FrameRecord& frame : frames)
    if (frame.result.tracked())
      poses.push_back({ frame.result.stamp_s, frame.result.T_session_camera });
  return poses;
}

Run trackRecording(const std::string& folder, const RunOptions& options)
{
  resetPeakMemory();  // the peak is that of this recording, whatever was tracked before it
  // On one core a decoder beside the tracker would be measured with it.
  source::TumFolderOptions folder_options;
  folder_options.decode_ahead = false;
  const std::unique_ptr<source::FrameSource> source = source::openTumFolder(folder, folder_options);
  rgbd::FrameBuilderOptions frame_options;
  frame_options.noise_model = options.noise_model;
  rgbd::FrameBuilder builder(frame_options);
  tracking::CameraTrackerOptions tracker_options;
  tracker_options.reference = options.object_reference ? tracking::Reference::OBJECT : tracking::Reference::SCENE;
  tracker_options.seed = options.seed;
  if (options.keyframe_angle_rad > 0)
    tracker_options.keyframe_angle_rad = options.keyframe_angle_rad;
  tracking::CameraTracker tracker(tracker_options);
  Run run;
  for (int index = 0; const std::optional<rgbd::RawFrame> raw = source->next(); ++index)
  {
    if (index < options.skip || (index - options.skip) % options.every != 0)
      continue;
    FrameRecord record;
    record.result.stamp_s = raw->stamp_s;
    const base::Result<rgbd::Frame> frame = builder.build(*raw);
    if (frame.ok())
    {
      const double wall_start_ms = wallTime_ms(), cpu_start_ms = cpuTime_ms();
      record.result = tracker.track(frame.value);
      record.wall_ms = wallTime_ms() - wall_start_ms;
      record.cpu_ms = cpuTime_ms() - cpu_start_ms;
    }
    else
    {
      ++run.unusable;
      record.result.reason = frame.status.message;
    }
    record.keyframe = record.result.keyframe.has_value();
    if (record.keyframe && options.keep_keyframes)
      run.keyframes.push_back(*record.result.keyframe);
    record.result.keyframe.reset();
    run.frames.push_back(std::move(record));
  }
  run.rss_mb = processMemory_mb("VmRSS");
  run.peak_rss_mb = peakMemory_mb();
  return run;
}

}  // namespace object_modelling::benchmark_tracking
