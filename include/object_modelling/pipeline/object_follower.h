#pragma once

#include <string>

#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::pipeline
{
/// Gives each frame of a recording the mask of one object that moves with respect to the camera, without known poses:
/// chosen automatically in the first frame, then the hypothesis that overlaps the last mask most. Masks that frames
/// bring are kept. Not thread safe.
class ObjectFollower
{
public:
  explicit ObjectFollower(const segmentation::SceneSegmenterOptions& options);

  /// Sets frame->object_mask; NO_RESULT with the reason where the object cannot be told from the rest.
  base::Status follow(rgbd::Frame* frame);

private:
  segmentation::SceneSegmenter segmenter_;
  cv::Mat last_mask_;
};

}  // namespace object_modelling::pipeline
