#include "wide_baseline_features.h"

#include <opencv2/features2d.hpp>

#include "depth_sampling.h"

namespace object_modelling::tracking
{
namespace
{
constexpr int MAX_ROBUST_FEATURES = 1000;
constexpr int MAX_QUICK_FEATURES = 500;  // comparing all with all takes longer than finding them
constexpr float MAX_DISTANCE_RATIO = 0.85F;
constexpr float MAX_DEPTH_STEP_RATIO = 0.03F;

#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 4)
cv::Ptr<cv::Feature2D> makeRobustDetector()
{
  return cv::SIFT::create(MAX_ROBUST_FEATURES, 3, 0.02);
}
#else
cv::Ptr<cv::Feature2D> makeRobustDetector()
{
  return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, 5e-4F);
}
#endif

cv::Ptr<cv::Feature2D> makeDetector(FeatureKind kind)
{
  constexpr int LEVELS = 6, BORDER_PX = 20, FAST_THRESHOLD = 12;
  if (kind == FeatureKind::QUICK)
    return cv::ORB::create(MAX_QUICK_FEATURES, 1.3F, LEVELS, BORDER_PX, 0, 2, cv::ORB::HARRIS_SCORE, 31,
                           FAST_THRESHOLD);
  return makeRobustDetector();
}

/// For each row of a its nearest row of b, -1 where the second nearest is about as near.
std::vector<int> distinctNearest(const cv::Mat& a, const cv::Mat& b, int norm)
{
  std::vector<int> nearest(a.rows, -1);
  std::vector<std::vector<cv::DMatch>> matches;
  cv::BFMatcher(norm).knnMatch(a, b, matches, 2);
  for (const std::vector<cv::DMatch>& candidates : matches)
    if (candidates.size() == 2 && candidates[0].distance < MAX_DISTANCE_RATIO * candidates[1].distance)
      nearest[candidates[0].queryIdx] = candidates[0].trainIdx;
  return nearest;
}
}  // namespace

WideBaselineFeatures detectWideBaselineFeatures(const rgbd::Frame& frame, FeatureKind kind)
{
  std::vector<cv::KeyPoint> keypoints;
  WideBaselineFeatures features;
  const cv::Ptr<cv::Feature2D> detector = makeDetector(kind);
  features.norm = detector->defaultNorm();
  detector->detectAndCompute(frame.gray, frame.object_mask, keypoints, features.descriptors);
  for (const cv::KeyPoint& keypoint : keypoints)
  {
    features.pixels.emplace_back(keypoint.pt.x, keypoint.pt.y);
    features.depths_m.push_back(sampleDepth_m(frame.depth_m, keypoint.pt.x, keypoint.pt.y, MAX_DEPTH_STEP_RATIO));
  }
  return features;
}

std::vector<FeatureMatch> matchFeatures(const WideBaselineFeatures& a, const WideBaselineFeatures& b)
{
  if (a.descriptors.rows < 2 || b.descriptors.rows < 2)
    return {};
  const std::vector<int> b_of_a = distinctNearest(a.descriptors, b.descriptors, a.norm);
  const std::vector<int> a_of_b = distinctNearest(b.descriptors, a.descriptors, a.norm);
  std::vector<FeatureMatch> matches;
  for (int i = 0; i < static_cast<int>(b_of_a.size()); ++i)
    if (b_of_a[i] >= 0 && a_of_b[b_of_a[i]] == i)
      matches.push_back({ i, b_of_a[i] });
  return matches;
}

}  // namespace object_modelling::tracking
