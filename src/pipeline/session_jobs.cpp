#include "object_modelling/pipeline/session_jobs.h"

#include "object_modelling/pipeline/session_refinement.h"
#include "session_loading.h"
#include "stage_marks.h"

namespace object_modelling::pipeline
{
SegmentReport segmentStoredSession(keyframes::SessionStore& store, const std::string& session_id,
                                   const std::optional<Eigen::Vector3d>& seed_point_session,
                                   const segmentation::ObjectMaskPropagatorOptions& options, base::JobControl& control)
{
  SegmentReport report;
  report.session_id = session_id;
  const keyframes::Session session = store.session(session_id);
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

  keyframes::SessionChange change;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    change.masks.push_back({ views[i].id, masks.masks[i] });
    report.masked_count += !masks.masks[i].empty();
  }
  report.support_plane_found = masks.support_plane_session.has_value();
  change.support_plane_session = masks.support_plane_session;
  change.segmented = segmentationMark(seed_point_session, options);
  store.update(session_id, change);
  return report;
}

bundle_adjustment::BundleAdjustmentResult refineStoredSession(keyframes::SessionStore& store,
                                                              const std::string& session_id,
                                                              bundle_adjustment::BundleAdjustmentOptions options,
                                                              base::JobControl& control)
{
  RefinementOptions by_bundle;
  by_bundle.method = RefinementMethod::BUNDLE_ADJUSTMENT;
  by_bundle.bundle_adjustment = options;
  const SessionRefinement refined = refineSessionBy(store, session_id, by_bundle, control);
  if (refined.bundle_adjustment)
    return *refined.bundle_adjustment;
  bundle_adjustment::BundleAdjustmentResult result;
  result.status = refined.status;
  return result;
}

}  // namespace object_modelling::pipeline
