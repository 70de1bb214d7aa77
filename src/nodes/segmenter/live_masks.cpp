#include "live_masks.h"

namespace object_modelling::nodes
{
LiveMasks::LiveMasks(const segmentation::ObjectMaskPropagatorOptions& options, bool automatic)
    : options_(options), automatic_(automatic), segmenter_(options.segmenter)
{
}

base::Result<cv::Mat> LiveMasks::add(const rgbd::Keyframe& keyframe, const std::string& session_id,
                                     Selection* selection)
{
  if (session_id != session_id_)
  {
    session_id_ = session_id;
    propagator_.reset();
    selection->beginSession(session_id, keyframe.T_session_camera);
  }
  return propagator_ ? propagator_->propagate(keyframe) : begin(keyframe, selection);
}

base::Result<cv::Mat> LiveMasks::begin(const rgbd::Keyframe& keyframe, Selection* selection)
{
  segmentation::SceneSegmentation segmentation = segmenter_.segment(keyframe.frame);
  selection->applyRoi(keyframe.T_session_camera, &segmentation);
  if (!segmentation.status.ok())
    return { segmentation.status, {} };
  const base::Result<int> chosen = choose(keyframe, segmentation, selection);
  if (!chosen.ok())
    return { chosen.status, {} };
  segmentation::ObjectMaskPropagator propagator(options_);
  const base::Status started = propagator.start(keyframe, segmentation, chosen.value);
  if (!started.ok())
    return { started, {} };
  propagator_.emplace(std::move(propagator));
  return { {}, segmentation.hypotheses[static_cast<std::size_t>(chosen.value)].mask };
}

base::Result<int> LiveMasks::choose(const rgbd::Keyframe& keyframe, const segmentation::SceneSegmentation& segmentation,
                                    Selection* selection) const
{
  base::Result<int> found = selection->find(segmentation, session_id_, keyframe.T_session_camera);
  if (found.ok() || selection->seed(session_id_) || !automatic_)
    return found;
  base::Result<int> chosen = segmentation::selectAutomatically(segmentation, keyframe.frame.camera);
  // What was chosen inside a box of the user's is a choice of the user's; without one the whole session decides later.
  if (chosen.ok() && selection->roiSet())
    selection->choose(segmentation.hypotheses[static_cast<std::size_t>(chosen.value)].centroid_camera, session_id_,
                      keyframe.T_session_camera);
  return chosen;
}

}  // namespace object_modelling::nodes
