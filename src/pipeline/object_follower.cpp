#include "object_modelling/pipeline/object_follower.h"

#include <algorithm>

namespace object_modelling::pipeline
{
namespace
{
// Below this the best hypothesis is taken to be another thing than the object of the last frame.
constexpr double MIN_MASK_OVERLAP_RATIO = 0.2;

/// Intersection over union of two masks of one size.
double overlapRatio(const cv::Mat& a, const cv::Mat& b)
{
  const int both = cv::countNonZero(a & b);
  const int either = cv::countNonZero(a | b);
  return either > 0 ? static_cast<double>(both) / either : 0.0;
}
}  // namespace

ObjectFollower::ObjectFollower(const segmentation::SceneSegmenterOptions& options) : segmenter_(options)
{
}

base::Status ObjectFollower::follow(rgbd::Frame* frame)
{
  if (!frame->object_mask.empty())
  {
    last_mask_ = frame->object_mask;
    return {};
  }
  const segmentation::SceneSegmentation segmentation = segmenter_.segment(*frame);
  if (!segmentation.status.ok())
    return segmentation.status;
  if (last_mask_.empty() || last_mask_.size() != frame->depth_m.size())
  {
    const base::Result<int> chosen = segmentation::selectAutomatically(segmentation, frame->camera);
    if (!chosen.ok())
      return chosen.status;
    last_mask_ = segmentation.hypotheses[chosen.value].mask;
  }
  else
  {
    double best_ratio = 0;
    const segmentation::Hypothesis* best = nullptr;
    for (const segmentation::Hypothesis& hypothesis : segmentation.hypotheses)
    {
      const double ratio = overlapRatio(hypothesis.mask, last_mask_);
      if (ratio > best_ratio)
      {
        best_ratio = ratio;
        best = &hypothesis;
      }
    }
    if (!best || best_ratio < MIN_MASK_OVERLAP_RATIO)
      return { base::StatusCode::NO_RESULT,
               "none of " + std::to_string(segmentation.hypotheses.size()) +
                   " hypotheses overlaps the object of the last frame: the object left the view or was covered" };
    last_mask_ = best->mask;
  }
  frame->object_mask = last_mask_;
  return {};
}

}  // namespace object_modelling::pipeline
