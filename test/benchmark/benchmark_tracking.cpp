// Tracks recordings and prints, for each, the processor time per frame (tracker alone), the share of frames tracked and
// the number of keyframes; writes the trajectories for scoring.
//   benchmark_tracking [--object] [--out FOLDER] RECORDING...
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/source/trajectory_file.h"
#include "object_modelling/source/tum_folder.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace
{
using namespace object_modelling;

/// Processor time of this process: what a frame costs, whatever else the machine is doing.
double cpuTime_ms()
{
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double quantile(std::vector<double> values, double share)
{
  if (values.empty())
    return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void run(const std::string& path, bool object_reference, const std::string& out, bool verbose)
{
  const auto source = source::openTumFolder(path);
  rgbd::FrameBuilder builder;
  tracking::CameraTrackerOptions options;
  options.reference = object_reference ? tracking::Reference::OBJECT : tracking::Reference::SCENE;
  tracking::CameraTracker tracker(options);
  std::vector<double> times_ms;
  std::vector<source::StampedPose> trajectory;
  int frames = 0, keyframes = 0, relocalised = 0;
  while (const auto raw = source->next())
  {
    ++frames;
    const base::Result<rgbd::Frame> frame = builder.build(*raw);
    if (!frame.ok())
      continue;
    const double start_ms = cpuTime_ms();
    const tracking::TrackingResult result = tracker.track(frame.value);
    times_ms.push_back(cpuTime_ms() - start_ms);
    if (result.tracked())
      trajectory.push_back({ result.stamp_s, result.T_session_camera });
    keyframes += result.keyframe.has_value();
    relocalised += result.status == tracking::TrackingStatus::RELOCALISED;
    if (verbose)
      std::printf("%.6f %s inliers %d of %d, %.2f px, blur %.2f%s %s\n", result.stamp_s, toString(result.status),
                  result.inlier_count, result.feature_count, result.reprojection_rmse_px, result.blur_ratio,
                  result.keyframe ? ", keyframe" : "", result.reason.c_str());
  }
  std::printf("%s: tracked %zu of %d, %d keyframes, %d relocalised, CPU ms per frame median %.1f p95 %.1f max %.1f\n",
              path.c_str(), trajectory.size(), frames, keyframes, relocalised, quantile(times_ms, 0.5),
              quantile(times_ms, 0.95), quantile(times_ms, 1));
  if (!out.empty())
    source::writeTrajectory(out + "/" + path.substr(path.find_last_of('/') + 1) + ".txt", trajectory);
}
}  // namespace

int main(int argc, char** argv)
{
  bool object_reference = false;
  bool verbose = false;
  std::string out;
  for (int i = 1; i < argc; ++i)
  {
    if (std::strcmp(argv[i], "--object") == 0)
      object_reference = true;
    else if (std::strcmp(argv[i], "--verbose") == 0)
      verbose = true;
    else if (std::strcmp(argv[i], "--out") == 0 && i + 1 < argc)
      out = argv[++i];
    else
      run(argv[i], object_reference, out, verbose);
  }
}
