#include "keyframe_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <opencv2/core/version.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace object_modelling::refinement
{
namespace
{
constexpr int MASK_MARGIN_PX = 4;
constexpr float MAX_DEPTH_STEP_RATIO = 0.02f;

#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 4)
constexpr int DESCRIPTOR_NORM = cv::NORM_L2;
cv::Ptr<cv::Feature2D> makeDetector(int max_features)
{
  return cv::SIFT::create(max_features, 3, 0.02);
}
#else
constexpr int DESCRIPTOR_NORM = cv::NORM_HAMMING;
cv::Ptr<cv::Feature2D> makeDetector(int /*max_features*/)
{
  return cv::AKAZE::create();
}
#endif

/// Mean depth of the 3x3 neighbourhood; NaN next to a hole or a step, where the surface under the feature is uncertain.
float depthUnder(const rgbd::Frame& frame, const cv::Point2f& pixel)
{
  constexpr float NONE = std::numeric_limits<float>::quiet_NaN();
  const int u = cvRound(pixel.x), v = cvRound(pixel.y);
  if (u < 1 || v < 1 || u >= frame.depth_m.cols - 1 || v >= frame.depth_m.rows - 1)
    return NONE;
  float sum = 0, low = std::numeric_limits<float>::infinity(), high = 0;
  for (int y = v - 1; y <= v + 1; ++y)
  {
    for (int x = u - 1; x <= u + 1; ++x)
    {
      const float z = frame.depthAt_m(x, y);
      if (!(z > 0))
        return NONE;
      sum += z;
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  return high - low > MAX_DEPTH_STEP_RATIO * low ? NONE : sum / 9;
}

cv::Mat insideOf(const cv::Mat& mask)
{
  cv::Mat inside;
  const cv::Size window(2 * MASK_MARGIN_PX + 1, 2 * MASK_MARGIN_PX + 1);
  cv::erode(mask, inside, cv::getStructuringElement(cv::MORPH_RECT, window));
  return inside;
}

/// The nearest two of a row or column of the distance matrix.
struct NearestTwo
{
  int index = -1;
  float first = std::numeric_limits<float>::infinity();
  float second = std::numeric_limits<float>::infinity();

  void add(int candidate, float distance)
  {
    if (distance < first)
    {
      second = first;
      first = distance;
      index = candidate;
    }
    else if (distance < second)
      second = distance;
  }
  bool distinct(double max_ratio) const { return first < max_ratio * second; }
};

}  // namespace

KeyframeFeatures detectFeatures(const rgbd::Frame& frame, int max_features, bool object_only)
{
  KeyframeFeatures result;
  result.norm = DESCRIPTOR_NORM;
  if (frame.gray.empty() || frame.depth_m.empty() || (object_only && frame.object_mask.empty()))
    return result;
  const cv::Ptr<cv::Feature2D> detector = makeDetector(max_features);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  detector->detectAndCompute(frame.gray, object_only ? insideOf(frame.object_mask) : cv::Mat(), keypoints, descriptors);

  std::vector<int> order(keypoints.size());
  std::iota(order.begin(), order.end(), 0);
  const auto by = [&](auto value)
  {
    std::stable_sort(order.begin(), order.end(),
                     [&](int i, int j) { return value(keypoints[i]) > value(keypoints[j]); });
  };
  by([](const cv::KeyPoint& keypoint) { return keypoint.response; });
  order.resize(std::min<std::size_t>(order.size(), max_features));
  by([](const cv::KeyPoint& keypoint) { return keypoint.size; });
  for (int index : order)
  {
    const cv::KeyPoint& keypoint = keypoints[index];
    Feature feature;
    feature.pixel = { keypoint.pt.x, keypoint.pt.y };
    feature.scale_px = keypoint.size;
    feature.depth_m = depthUnder(frame, keypoint.pt);
    feature.p_camera = frame.camera.unproject(keypoint.pt.x, keypoint.pt.y, feature.depth_m);
    result.features.push_back(feature);
    result.descriptors.push_back(descriptors.row(index));
  }
  return result;
}

std::vector<FeatureMatch> matchFeatures(const KeyframeFeatures& a, const KeyframeFeatures& b, double max_ratio,
                                        int first_a, int first_b)
{
  const int rows_a = first_a > 0 ? std::min(first_a, a.descriptors.rows) : a.descriptors.rows;
  const int rows_b = first_b > 0 ? std::min(first_b, b.descriptors.rows) : b.descriptors.rows;
  std::vector<FeatureMatch> result;
  if (rows_a < 2 || rows_b < 2)
    return result;
  cv::Mat distances;
  cv::batchDistance(a.descriptors.rowRange(0, rows_a), b.descriptors.rowRange(0, rows_b), distances,
                    a.norm == cv::NORM_L2 ? CV_32F : CV_32S, cv::noArray(), a.norm);
  if (distances.type() != CV_32FC1)
    distances.convertTo(distances, CV_32F);

  std::vector<NearestTwo> of_a(rows_a), of_b(rows_b);
  for (int i = 0; i < rows_a; ++i)
  {
    const float* row = distances.ptr<float>(i);
    for (int j = 0; j < rows_b; ++j)
    {
      of_a[i].add(j, row[j]);
      of_b[j].add(i, row[j]);
    }
  }
  for (int i = 0; i < rows_a; ++i)
  {
    const int j = of_a[i].index;
    if (j >= 0 && of_b[j].index == i && of_a[i].distinct(max_ratio) && of_b[j].distinct(max_ratio))
      result.push_back({ i, j, of_a[i].first });
  }
  return result;
}

}  // namespace object_modelling::refinement
