#include "tracking_refinement.h"

#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/source/trajectory_correction.h"
#include "support/temp_dir.h"

namespace object_modelling::benchmark_tracking
{
Refined refineRun(const Run& run, const RunOptions& options)
{
  Refined refined;
  const test_support::TempDir folder;
  const auto store = keyframes::openSqlStore(folder.path() + "/keyframes.sqlite");
  keyframes::Session session;
  session.id = "benchmark";
  session.reference_is_object = options.object_reference;
  session.calibration.noise_model = options.noise_model;
  store->createSession(session);
  for (const rgbd::Keyframe& keyframe : run.keyframes)
    store->addKeyframe(session.id, keyframe);

  const double wall_start_ms = wallTime_ms(), cpu_start_ms = cpuTime_ms();
  bundle_adjustment::BundleAdjustmentOptions bundle;
  bundle.seed = options.seed;
  base::JobControl control;
  const bundle_adjustment::BundleAdjustmentResult result =
      pipeline::refineStoredSession(*store, session.id, bundle, control);
  refined.links = result.links.size();
  if (result.status.ok())
  {
    std::vector<double> stamps_s;
    std::vector<Eigen::Isometry3d> before;
    for (const rgbd::Keyframe& keyframe : run.keyframes)
    {
      stamps_s.push_back(keyframe.frame.stamp_s);
      before.push_back(keyframe.T_session_camera);
    }
    refined.trajectory = source::correctTrajectory(run.trajectory(), stamps_s, before, result.T_session_camera);
  }
  else
    refined.problem = result.status.message;
  refined.wall_s = 1e-3 * (wallTime_ms() - wall_start_ms);
  refined.cpu_s = 1e-3 * (cpuTime_ms() - cpu_start_ms);
  return refined;
}

}  // namespace object_modelling::benchmark_tracking
