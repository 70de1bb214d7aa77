#include "wide_baseline_features.h"

#include "object_modelling/rgbd/depth_sampling.h"

namespace object_modelling::tracking
{
namespace
{
constexpr int MAX_ROBUST_FEATURES = 1000;
constexpr int MAX_QUICK_FEATURES = 500;  // comparing all with all takes longer than finding them
constexpr double MAX_DISTANCE_RATIO = 0.85;
constexpr float MAX_DEPTH_STEP_RATIO = 0.03F;
}  // namespace

WideBaselineFeatures detectWideBaselineFeatures(const rgbd::Frame& frame, FeatureKind kind)
{
  const features::DescribedPoints found =
      kind == FeatureKind::QUICK ? features::detectQuick(frame.gray, frame.object_mask, MAX_QUICK_FEATURES)
                                 : features::detectScaleInvariant(frame.gray, frame.object_mask, MAX_ROBUST_FEATURES);
  WideBaselineFeatures result;
  result.norm = found.norm;
  result.descriptors = found.descriptors;
  for (const cv::Point2f& pixel : found.pixels)
  {
    result.pixels.emplace_back(pixel.x, pixel.y);
    result.depths_m.push_back(rgbd::sampleDepth_m(frame.depth_m, pixel.x, pixel.y, MAX_DEPTH_STEP_RATIO));
  }
  return result;
}

std::vector<features::DescriptorMatch> matchFeatures(const WideBaselineFeatures& a, const WideBaselineFeatures& b)
{
  return features::matchDescriptors(a.descriptors, b.descriptors, a.norm, MAX_DISTANCE_RATIO);
}

}  // namespace object_modelling::tracking
