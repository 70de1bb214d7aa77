#include "wide_baseline_features.h"

#include <opencv2/features2d.hpp>

#include "depth_sampling.h"

namespace object_modelling::tracking
{
namespace
{
constexpr int MAX_FEATURES = 1000;
constexpr float MAX_DISTANCE_RATIO = 0.85F;
constexpr float MAX_DEPTH_STEP_RATIO = 0.03F;

#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 4)
cv::Ptr<cv::Feature2D> makeDetector()
{
  return cv::SIFT::create(MAX_FEATURES, 3, 0.02);
}
constexpr int DESCRIPTOR_NORM = cv::NORM_L2;
#else
cv::Ptr<cv::Feature2D> makeDetector()
{
  return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, 5e-4F);
}
constexpr int DESCRIPTOR_NORM = cv::NORM_HAMMING;
#endif

/// For each row of a its nearest row of b, -1 where the second nearest is about as near.
std::vector<int> distinctNearest(const cv::Mat& a, const cv::Mat& b)
{
  std::vector<int> nearest(a.rows, -1);
  std::vector<std::vector<cv::DMatch>> matches;
  cv::BFMatcher(DESCRIPTOR_NORM).knnMatch(a, b, matches, 2);
  for (const std::vector<cv::DMatch>& candidates : matches)
    if (candidates.size() == 2 && candidates[0].distance < MAX_DISTANCE_RATIO * candidates[1].distance)
      nearest[candidates[0].queryIdx] = candidates[0].trainIdx;
  return nearest;
}
}  // namespace

WideBaselineFeatures detectWideBaselineFeatures(const rgbd::Frame& frame)
{
  std::vector<cv::KeyPoint> keypoints;
  WideBaselineFeatures features;
  makeDetector()->detectAndCompute(frame.gray, frame.object_mask, keypoints, features.descriptors);
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
  const std::vector<int> b_of_a = distinctNearest(a.descriptors, b.descriptors);
  const std::vector<int> a_of_b = distinctNearest(b.descriptors, a.descriptors);
  std::vector<FeatureMatch> matches;
  for (int i = 0; i < static_cast<int>(b_of_a.size()); ++i)
    if (b_of_a[i] >= 0 && a_of_b[b_of_a[i]] == i)
      matches.push_back({ i, b_of_a[i] });
  return matches;
}

}  // namespace object_modelling::tracking
