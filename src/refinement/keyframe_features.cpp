#include "object_modelling/refinement/keyframe_features.h"

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
// Detection takes most of the time of linking, in proportion to the area. In halved images it finds what links views as
// well, and bundle adjustment ends as near the truth.
constexpr int MAX_AREA_PX = 400 * 400;

#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 4)
constexpr int DESCRIPTOR_NORM = cv::NORM_L2;
// SIFT starts from an image of twice the size but maps its pixel centres back as x / 2, not (x + 1/2) / 2 - 1/2
// (measured on Gaussian blobs: +0.24 px in x and y at any scale).
constexpr float PIXEL_OFFSET_PX = 0.25f;
cv::Ptr<cv::Feature2D> makeDetector(int max_features)
{
  return cv::SIFT::create(max_features, 3, 0.02);
}
#else
constexpr int DESCRIPTOR_NORM = cv::NORM_HAMMING;
constexpr float PIXEL_OFFSET_PX = 0;
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

/// Halved until it is small enough; the factor from its pixels to those given. A last odd row or column is cut off, so
/// that the factor is exact.
int halve(cv::Mat* image, cv::Mat* mask)
{
  int factor = 1;
  for (; static_cast<int>(image->total()) > MAX_AREA_PX; factor *= 2)
  {
    const cv::Size half = image->size() / 2;
    const cv::Rect even({ 0, 0 }, half * 2);
    cv::resize((*image)(even), *image, half, 0, 0, cv::INTER_AREA);
    if (!mask->empty())
      cv::resize((*mask)(even), *mask, half, 0, 0, cv::INTER_NEAREST);
  }
  return factor;
}

/// Bounding box of the mask with room for the patches of features near its rim.
cv::Rect surroundings(const cv::Mat& mask)
{
  constexpr int ROOM_PX = 32;
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty())
    return {};
  return (box - cv::Point(ROOM_PX, ROOM_PX) + cv::Size(2 * ROOM_PX, 2 * ROOM_PX)) & cv::Rect({ 0, 0 }, mask.size());
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

/// CV_32FC1, squared for NORM_L2. One matrix product for those: twice as fast as difference by difference, and exact,
/// as SIFT's descriptors hold whole numbers below 256.
cv::Mat distanceMatrix(const cv::Mat& a, const cv::Mat& b, int norm)
{
  cv::Mat distances(a.rows, b.rows, CV_32F);
  if (norm != cv::NORM_L2)
  {
    cv::Mat counts;
    cv::batchDistance(a, b, counts, CV_32S, cv::noArray(), norm);
    counts.convertTo(distances, CV_32F);
    return distances;
  }
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Rows> A(a.ptr<float>(), a.rows, a.cols), B(b.ptr<float>(), b.rows, b.cols);
  Eigen::Map<Rows> D(distances.ptr<float>(), a.rows, b.rows);
  D.noalias() = -2 * A * B.transpose();
  D.colwise() += A.rowwise().squaredNorm();
  D.rowwise() += B.rowwise().squaredNorm().transpose();
  return distances;
}

}  // namespace

KeyframeFeatures detectFeatures(const rgbd::Frame& frame, int max_features, bool object_only)
{
  KeyframeFeatures result;
  result.norm = DESCRIPTOR_NORM;
  if (frame.gray.empty() || frame.depth_m.empty() || (object_only && frame.object_mask.empty()))
    return result;
  const cv::Ptr<cv::Feature2D> detector = makeDetector(max_features);
  std::vector<cv::KeyPoint> keypoints;
  // The object is often a small part of the image, and time goes with the area.
  const cv::Rect area = object_only ? surroundings(frame.object_mask) : cv::Rect({ 0, 0 }, frame.gray.size());
  if (area.empty())
    return result;
  const cv::Point2f corner(area.tl());
  cv::Mat gray = frame.gray(area), mask = object_only ? insideOf(frame.object_mask)(area) : cv::Mat(), descriptors;
  const auto factor = static_cast<float>(halve(&gray, &mask));
  detector->detectAndCompute(gray, mask, keypoints, descriptors);

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
    const cv::Point2f centred = keypoint.pt - cv::Point2f(PIXEL_OFFSET_PX - 0.5f, PIXEL_OFFSET_PX - 0.5f);
    const cv::Point2f pixel = factor * centred - cv::Point2f(0.5f, 0.5f) + corner;
    Feature feature;
    feature.pixel = { pixel.x, pixel.y };
    feature.scale_px = factor * keypoint.size;
    feature.depth_m = depthUnder(frame, pixel);
    feature.p_camera = frame.camera.unproject(pixel.x, pixel.y, feature.depth_m);
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
  const cv::Mat distances =
      distanceMatrix(a.descriptors.rowRange(0, rows_a), b.descriptors.rowRange(0, rows_b), a.norm);
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
  const double ratio = a.norm == cv::NORM_L2 ? max_ratio * max_ratio : max_ratio;
  for (int i = 0; i < rows_a; ++i)
  {
    const int j = of_a[i].index;
    if (j >= 0 && of_b[j].index == i && of_a[i].distinct(ratio) && of_b[j].distinct(ratio))
      result.push_back({ i, j });
  }
  return result;
}

}  // namespace object_modelling::refinement
