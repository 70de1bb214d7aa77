#pragma once

#include <optional>
#include <string>

#include "object_modelling/segmentation/object_mask_propagator.h"
#include "selection.h"

namespace object_modelling::nodes
{
/// Masks of the chosen object in the keyframes of the session that is being recorded, one by one as they come. They
/// show the object while it grows; ~segment_session makes the final ones. Free of ROS. Not thread safe.
class LiveMasks
{
public:
  LiveMasks(const segmentation::ObjectMaskPropagatorOptions& options, bool automatic);

  /// The object has been chosen anew, or no longer is: begins again with the next keyframe.
  void restart() { propagator_.reset(); }

  /// Mask (CV_8UC1); NO_RESULT or FAILED_PRECONDITION where there is none.
  base::Result<cv::Mat> add(const rgbd::Keyframe& keyframe, const std::string& session_id, Selection* selection);

private:
  base::Result<cv::Mat> begin(const rgbd::Keyframe& keyframe, Selection* selection);
  base::Result<int> choose(const rgbd::Keyframe& keyframe, const segmentation::SceneSegmentation& segmentation,
                           Selection* selection) const;

  segmentation::ObjectMaskPropagatorOptions options_;
  bool automatic_;
  segmentation::SceneSegmenter segmenter_;
  std::string session_id_;
  std::optional<segmentation::ObjectMaskPropagator> propagator_;
};

}  // namespace object_modelling::nodes
