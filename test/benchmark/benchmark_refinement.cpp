// benchmark_refinement <TUM-style folder> <output prefix> [scene|object] [threads]
// Tracks a recording, refines its keyframes, and prints residuals, links, closures and times. Writes, in TUM format,
// <prefix>_live.txt, <prefix>_corrected.txt (all frames), <prefix>_keyframes_before.txt and <prefix>_keyframes.txt.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "object_modelling/refinement/bundle_adjustment.h"
#include "object_modelling/refinement/trajectory_correction.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/source/tum_folder.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling
{
namespace
{
constexpr double DEGREES = 180 / 3.14159265358979323846;

double wallTime_s()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpuTime_s()
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/// Prints when a new stage begins.
class StageClock
{
public:
  void enter(const std::string& stage)
  {
    if (stage == stage_)
      return;
    const double wall_s = wallTime_s(), cpu_s = cpuTime_s();
    if (!stage_.empty())
      std::printf("%-20s %6.2f s, %6.2f s of cores\n", stage_.c_str(), wall_s - wall_s_, cpu_s - cpu_s_);
    stage_ = stage;
    wall_s_ = wall_s;
    cpu_s_ = cpu_s;
  }

private:
  std::string stage_;
  double wall_s_ = 0, cpu_s_ = 0;
};

struct Recording
{
  std::vector<source::StampedPose> live;
  std::vector<rgbd::Keyframe> keyframes;
  int frames = 0;
};

Recording track(const std::string& folder, tracking::Reference reference)
{
  const std::unique_ptr<source::FrameSource> recording = source::openTumFolder(folder);
  rgbd::FrameBuilder builder;
  tracking::CameraTrackerOptions options;
  options.reference = reference;
  tracking::CameraTracker tracker(options);
  Recording result;
  while (const std::optional<rgbd::RawFrame> raw = recording->next())
  {
    ++result.frames;
    const base::Result<rgbd::Frame> frame = builder.build(*raw);
    if (!frame.ok())
      continue;
    const tracking::TrackingResult tracked = tracker.track(frame.value);
    if (!tracked.tracked())
      continue;
    result.live.push_back({ tracked.stamp_s, tracked.T_session_camera });
    if (tracked.keyframe)
      result.keyframes.push_back(*tracked.keyframe);
  }
  return result;
}

void printResult(const refinement::BundleAdjustmentResult& result)
{
  std::printf("status %d %s\ncost %.1f -> %.1f in %d iterations, %zu left out\n", static_cast<int>(result.status.code),
              result.status.message.c_str(), result.initial_cost, result.final_cost, result.iterations,
              result.left_out.size());
  for (const refinement::KeyframeResidual& residual : result.residuals)
  {
    std::printf("keyframe %3d: %4d observations, %.2f -> %.2f px, %.2f -> %.2f mm\n", residual.keyframe_id,
                residual.observation_count, residual.reprojection_rmse_before_px, residual.reprojection_rmse_after_px,
                1e3 * residual.depth_rmse_before_m, 1e3 * residual.depth_rmse_after_m);
  }
  const auto print_link = [](const char* kind, const refinement::KeyframeLink& link)
  {
    std::printf("%s %3d %3d: %4d matches, %6.1f mm %5.2f deg -> %5.1f mm %5.2f deg\n", kind, link.keyframe_a,
                link.keyframe_b, link.inlier_count, 1e3 * link.translation_error_before_m,
                DEGREES * link.rotation_error_before_rad, 1e3 * link.translation_error_after_m,
                DEGREES * link.rotation_error_after_rad);
  };
  for (const refinement::KeyframeLink& link : result.links)
    print_link("link    ", link);
  for (const refinement::KeyframeLink& link : result.rejected_links)
    print_link("rejected", link);
}

void writeTrajectories(const std::string& prefix, const Recording& recording,
                       const refinement::BundleAdjustmentResult& result)
{
  std::vector<source::StampedPose> keyframes_before, keyframes_after;
  std::vector<double> stamps_s;
  std::vector<Eigen::Isometry3d> before;
  for (std::size_t k = 0; k < recording.keyframes.size(); ++k)
  {
    const rgbd::Keyframe& keyframe = recording.keyframes[k];
    stamps_s.push_back(keyframe.frame.stamp_s);
    before.push_back(keyframe.T_session_camera);
    keyframes_before.push_back({ keyframe.frame.stamp_s, keyframe.T_session_camera });
    keyframes_after.push_back({ keyframe.frame.stamp_s, result.T_session_camera[k] });
  }
  source::writeTrajectory(prefix + "_live.txt", recording.live);
  source::writeTrajectory(prefix + "_keyframes_before.txt", keyframes_before);
  source::writeTrajectory(prefix + "_keyframes.txt", keyframes_after);
  source::writeTrajectory(prefix + "_corrected.txt",
                          refinement::correctTrajectory(recording.live, stamps_s, before, result.T_session_camera));
}

int run(const std::string& folder, const std::string& prefix, bool object_only, int threads)
{
  StageClock clock;
  clock.enter("tracking");
  const Recording recording = track(folder, object_only ? tracking::Reference::OBJECT : tracking::Reference::SCENE);
  refinement::BundleAdjustmentOptions options;
  options.object_only = object_only;
  options.threads = threads;
  base::JobControl control([&](const base::Progress& progress) { clock.enter(progress.stage); });
  const double begin_s = wallTime_s();
  const refinement::BundleAdjustmentResult result = refinement::adjustBundle(recording.keyframes, options, control);
  const double end_s = wallTime_s();
  clock.enter("writing");
  std::printf("%d frames, %zu tracked, %zu keyframes, refined in %.2f s\n", recording.frames, recording.live.size(),
              recording.keyframes.size(), end_s - begin_s);
  printResult(result);
  writeTrajectories(prefix, recording, result);
  return result.status.ok() ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace object_modelling

int main(int argc, char** argv)
{
  if (argc < 3)
  {
    std::fprintf(stderr, "usage: benchmark_refinement <TUM-style folder> <output prefix> [scene|object] [threads]\n");
    return EXIT_FAILURE;
  }
  try
  {
    return object_modelling::run(argv[1], argv[2], argc > 3 && std::string(argv[3]) == "object",
                                 argc > 4 ? std::max(1, std::atoi(argv[4])) : 1);
  }
  catch (const object_modelling::base::Error& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
