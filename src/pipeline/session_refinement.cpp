#include "object_modelling/pipeline/session_refinement.h"

#include <algorithm>
#include <utility>

#include "object_modelling/base/options.h"
#include "object_modelling/report/refinement_report.h"
#include "object_modelling/segmentation/object_follower.h"
#include "refiner.h"
#include "session_loading.h"
#include "stage_marks.h"

namespace object_modelling::pipeline
{
namespace
{
/// The turntable of a keyframe whose recording has no masks of what moves with the object; empty where there is none.
/// The tracker's decision is better than a single view's: it has landmarks there.
cv::Mat turntableOf(const rgbd::Keyframe& keyframe)
{
  constexpr int MIN_LANDMARKS = 5;
  const cv::Mat turntable = segmentation::findTurntable(keyframe.frame);
  const auto landmarks = std::count_if(
      keyframe.observations.begin(), keyframe.observations.end(),
      [&](const rgbd::Observation& seen)
      {
        const cv::Point pixel(cvRound(seen.pixel.x()), cvRound(seen.pixel.y()));
        return cv::Rect({ 0, 0 }, turntable.size()).contains(pixel) && turntable.at<std::uint8_t>(pixel) != 0;
      });
  return landmarks >= MIN_LANDMARKS ? turntable : cv::Mat();
}

/// Turntables count for the motion of their objects, and are not in the masks of these.
void addTurntables(std::vector<rgbd::Keyframe>* keyframes)
{
  for (rgbd::Keyframe& keyframe : *keyframes)
  {
    rgbd::Frame& frame = keyframe.frame;
    if (frame.moving_mask.empty() && !frame.object_mask.empty())
      if (const cv::Mat turntable = turntableOf(keyframe); !turntable.empty())
        frame.moving_mask = frame.object_mask | turntable;
    frame.object_mask = frame.trackedMask();
  }
}

/// What is written. The report of an earlier bundle adjustment goes with the poses that it was of.
keyframes::SessionChange changeBy(const SessionRefinement& refined, const std::vector<rgbd::Keyframe>& keyframes,
                                  const keyframes::Session& before, const RefinementOptions& options)
{
  keyframes::SessionChange change;
  for (const rgbd::Keyframe& keyframe : keyframes)
    change.poses.push_back({ keyframe.id, keyframe.T_session_camera, keyframe.covariance });
  change.refined = refinementMark(options, refined);
  change.refinement_report = "";
  if (refined.chosen != nameOf(RefinementMethod::BUNDLE_ADJUSTMENT) && refined.chosen != nameOf(RefinementMethod::BOTH))
    return change;
  change.refinement_report = report::refinementReportYaml(*refined.bundle_adjustment);
  change.calibration = before.calibration;
  change.calibration->correction = before.calibration.correction.then(refined.bundle_adjustment->sensor);
  if (options.bundle_adjustment.calibrate_color_offset)
    change.calibration->color_offset_px = refined.bundle_adjustment->color_offset_px;
  return change;
}
}  // namespace

std::vector<std::string> RefinementOptions::violations() const
{
  base::OptionsCheck check("refinement");
  check.include(bundle_adjustment.violations());
  check.include(multi_view_icp.violations());
  return check.violations();
}

SessionRefinement refineSessionBy(keyframes::SessionStore& store, const std::string& session_id,
                                  RefinementOptions options, base::JobControl& control)
{
  base::checked(options);
  const keyframes::Session session = store.session(session_id);
  options.bundle_adjustment.object_only |= session.reference_is_object;
  options.multi_view_icp.object_only |= session.reference_is_object;
  // A calibration determines the offset better than one session.
  if (session.calibration.noise_model.shiftsColor())
    options.bundle_adjustment.calibrate_color_offset = false;
  std::vector<rgbd::Keyframe> keyframes = loadReported(store, session_id, control);
  SessionRefinement refined;
  if (keyframes.empty())
  {
    refined.status = noKeyframes(session_id);
    return refined;
  }
  if (options.bundle_adjustment.object_only)
    addTurntables(&keyframes);
  Refiner refiner(options, std::move(keyframes), session.calibration.color_offset_px, control);
  refined = refiner.run();
  if (!refined.status.ok() && refined.chosen == "live")
    return refined;
  control.checkCancelled();
  store.update(session_id, changeBy(refined, refiner.keyframes(), session, options));
  return refined;
}

std::string nameOf(RefinementMethod method)
{
  switch (method)
  {
    case RefinementMethod::BUNDLE_ADJUSTMENT:
      return "bundle_adjustment";
    case RefinementMethod::MULTI_VIEW_ICP:
      return "multi_view_icp";
    case RefinementMethod::BOTH:
      break;
  }
  return "both";
}

RefinementMethod refinementMethodFrom(const std::string& name)
{
  for (const RefinementMethod method :
       { RefinementMethod::BUNDLE_ADJUSTMENT, RefinementMethod::MULTI_VIEW_ICP, RefinementMethod::BOTH })
    if (nameOf(method) == name)
      return method;
  throw base::Error(base::StatusCode::INVALID_ARGUMENT, "refinement method '" + name +
                                                            "' is not known: use bundle_adjustment, multi_view_icp or "
                                                            "both");
}

}  // namespace object_modelling::pipeline
