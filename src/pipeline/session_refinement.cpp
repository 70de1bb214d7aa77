#include "object_modelling/pipeline/session_refinement.h"

#include <algorithm>

#include "object_modelling/base/options.h"
#include "object_modelling/rgbd/corrected.h"
#include "object_modelling/segmentation/object_follower.h"
#include "refinement_report.h"
#include "session_loading.h"
#include "stage_marks.h"

namespace object_modelling::pipeline
{
namespace
{
/// Turntables count for the motion of their objects, and are not in the stored masks. The tracker knows better than a
/// single view whether something is one: it has landmarks there.
void addTurntables(std::vector<rgbd::Keyframe>* keyframes)
{
  constexpr int MIN_LANDMARKS = 5;
  for (rgbd::Keyframe& keyframe : *keyframes)
  {
    if (keyframe.frame.object_mask.empty())
      continue;
    const cv::Mat turntable = segmentation::findTurntable(keyframe.frame);
    const auto landmarks = std::count_if(
        keyframe.observations.begin(), keyframe.observations.end(),
        [&](const rgbd::Observation& seen)
        {
          const cv::Point pixel(cvRound(seen.pixel.x()), cvRound(seen.pixel.y()));
          return cv::Rect({ 0, 0 }, turntable.size()).contains(pixel) && turntable.at<std::uint8_t>(pixel) != 0;
        });
    if (landmarks >= MIN_LANDMARKS)
      keyframe.frame.object_mask = keyframe.frame.object_mask | turntable;
  }
}

/// Takes over the outcome of one step; false if it failed.
template <typename Result>
bool takeOver(const Result& result, std::vector<rgbd::Keyframe>* keyframes)
{
  if (!result.status.ok())
    return false;
  for (std::size_t i = 0; i < keyframes->size(); ++i)
  {
    (*keyframes)[i].T_session_camera = result.T_session_camera[i];
    (*keyframes)[i].covariance =
        i < result.covariance.size() ? result.covariance[i] : geometry::Matrix6d(geometry::Matrix6d::Zero());
  }
  return true;
}
/// What is written. The report of an earlier bundle adjustment goes with the poses that it was of.
keyframes::SessionChange changeBy(const SessionRefinement& refined, const std::vector<rgbd::Keyframe>& keyframes,
                                  const keyframes::Session& before, const RefinementOptions& options)
{
  keyframes::SessionChange change;
  for (const rgbd::Keyframe& keyframe : keyframes)
    change.poses.push_back({ keyframe.id, keyframe.T_session_camera, keyframe.covariance });
  change.refined = refinementMark(options);
  change.refinement_report = "";
  if (!refined.bundle_adjustment || !refined.bundle_adjustment->status.ok())
    return change;
  change.refinement_report = refinementReportYaml(*refined.bundle_adjustment);
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
  options.multi_view_icp.color_offset_px = session.calibration.color_offset_px;
  // What one session tells of the offset is less than a calibration does.
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
  bool moved = false;
  if (options.method != RefinementMethod::MULTI_VIEW_ICP)
  {
    refined.bundle_adjustment = refinement::adjustBundle(keyframes, options.bundle_adjustment, control);
    moved = takeOver(*refined.bundle_adjustment, &keyframes);
    if (moved && !refined.bundle_adjustment->sensor.isIdentity())
      for (rgbd::Keyframe& keyframe : keyframes)
        keyframe = rgbd::corrected(keyframe, refined.bundle_adjustment->sensor);
    refined.status = refined.bundle_adjustment->status;
  }
  if (options.method != RefinementMethod::BUNDLE_ADJUSTMENT)
  {
    if (moved)
    {
      options.multi_view_icp.start_error_m = std::min(AFTER_BUNDLE_M, options.multi_view_icp.start_error_m);
      options.multi_view_icp.color_offset_px = refined.bundle_adjustment->color_offset_px;
    }
    refined.multi_view_icp = refinement::refineByMultiViewIcp(keyframes, options.multi_view_icp, control);
    const bool aligned = takeOver(*refined.multi_view_icp, &keyframes);
    if (!moved)
      refined.status = refined.multi_view_icp->status;
    moved |= aligned;
  }
  for (const rgbd::Keyframe& keyframe : keyframes)
    refined.T_session_camera.push_back(keyframe.T_session_camera);
  if (!moved)
    return refined;
  control.checkCancelled();
  store.update(session_id, changeBy(refined, keyframes, session, options));
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
