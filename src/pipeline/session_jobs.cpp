#include "object_modelling/pipeline/session_jobs.h"

#include <algorithm>

#include "object_modelling/segmentation/object_follower.h"

namespace object_modelling::pipeline
{
namespace
{
std::vector<rgbd::Keyframe> loadReported(keyframes::SessionStore& store, const std::string& session_id,
                                         base::JobControl& control)
{
  const std::vector<int> ids = store.keyframeIds(session_id);
  std::vector<rgbd::Keyframe> keyframes;
  keyframes.reserve(ids.size());
  for (const int id : ids)
  {
    control.report("load", keyframes.size(), ids.size());
    keyframes.push_back(store.keyframe(session_id, id));
  }
  control.report("load", ids.size(), ids.size());
  return keyframes;
}

base::Status noKeyframes(const std::string& session_id)
{
  return { base::StatusCode::FAILED_PRECONDITION,
           "session '" + session_id + "' has no keyframes: record it with the camera tracking the scene first" };
}
}  // namespace

SegmentReport segmentSession(keyframes::SessionStore& store, const std::string& session_id,
                             const std::optional<Eigen::Vector3d>& seed_point_session,
                             const segmentation::ObjectMaskPropagatorOptions& options, base::JobControl& control)
{
  SegmentReport report;
  report.session_id = session_id;
  keyframes::Session session = store.session(session_id);
  const std::vector<rgbd::Keyframe> keyframes = loadReported(store, session_id, control);
  report.keyframe_count = static_cast<int>(keyframes.size());
  if (keyframes.empty())
  {
    report.status = noKeyframes(session_id);
    return report;
  }
  // Masks of a session that was tracked by them are measurements; those of an earlier segmentation are made anew.
  std::vector<rgbd::Keyframe> views = keyframes;
  if (!session.reference_is_object)
    for (rgbd::Keyframe& view : views)
      view.frame.object_mask.release();

  control.report("segment", 0, keyframes.size());
  const segmentation::SessionMasks masks = segmentation::segmentSession(views, seed_point_session, options);
  control.report("segment", keyframes.size(), keyframes.size());
  report.status = masks.status;
  if (!masks.status.ok())
    return report;

  std::vector<keyframes::MaskUpdate> updates;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    updates.push_back({ views[i].id, masks.masks[i] });
    report.masked_count += !masks.masks[i].empty();
  }
  store.updateMasks(session_id, updates);
  report.support_plane_found = masks.support_plane_session.has_value();
  session.support_plane_session = masks.support_plane_session;
  store.updateSession(session);
  return report;
}

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
}  // namespace

refinement::BundleAdjustmentResult refineSession(keyframes::SessionStore& store, const std::string& session_id,
                                                 refinement::BundleAdjustmentOptions options, base::JobControl& control)
{
  keyframes::Session session = store.session(session_id);
  options.object_only |= session.reference_is_object;
  std::vector<rgbd::Keyframe> keyframes = loadReported(store, session_id, control);
  if (keyframes.empty())
  {
    refinement::BundleAdjustmentResult result;
    result.status = noKeyframes(session_id);
    return result;
  }
  if (options.object_only)
    addTurntables(&keyframes);
  refinement::BundleAdjustmentResult result = refinement::adjustBundle(keyframes, options, control);
  if (!result.status.ok())
    return result;
  control.checkCancelled();
  std::vector<keyframes::PoseUpdate> updates;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    updates.push_back(
        { keyframes[i].id, result.T_session_camera[i],
          i < result.covariance.size() ? result.covariance[i] : geometry::Matrix6d(geometry::Matrix6d::Zero()) });
  store.updatePoses(session_id, updates);
  if (options.calibrate_color_offset)
  {
    session.calibration.color_offset_px = result.color_offset_px;
    store.updateSession(session);
  }
  return result;
}

alignment::AlignmentResult alignSessions(keyframes::SessionStore& store, const std::vector<std::string>& session_ids,
                                         base::JobControl& control)
{
  std::vector<keyframes::Session> sessions;
  for (const std::string& id : session_ids)
    sessions.push_back(store.session(id));
  return alignment::alignSessions(sessions, control);
}

}  // namespace object_modelling::pipeline
