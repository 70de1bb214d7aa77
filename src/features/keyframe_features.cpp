#include "object_modelling/features/keyframe_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <opencv2/imgproc.hpp>

namespace object_modelling::features
{
namespace
{
constexpr int MASK_MARGIN_PX = 4;
constexpr float MAX_DEPTH_STEP_RATIO = 0.02f;
// Detection takes most of the time of linking, in proportion to the area. In halved images it finds what links views as
// well, and bundle adjustment ends as near the truth.
constexpr int MAX_AREA_PX = 400 * 400;

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

}  // namespace

KeyframeFeatures detectFeatures(const rgbd::Frame& frame, int max_features, bool object_only)
{
  KeyframeFeatures result;
  if (frame.gray.empty() || frame.depth_m.empty() || (object_only && frame.object_mask.empty()))
    return result;
  // The object is often a small part of the image, and time goes with the area.
  const cv::Rect area = object_only ? surroundings(frame.object_mask) : cv::Rect({ 0, 0 }, frame.gray.size());
  if (area.empty())
    return result;
  const cv::Point2f corner(area.tl());
  cv::Mat gray = frame.gray(area), mask = object_only ? insideOf(frame.object_mask)(area) : cv::Mat();
  const auto factor = static_cast<float>(halve(&gray, &mask));
  const DescribedPoints found = detectScaleInvariant(gray, mask, max_features);
  result.norm = found.norm;

  std::vector<int> order(found.pixels.size());
  std::iota(order.begin(), order.end(), 0);
  const auto by = [&](const std::vector<float>& values)
  { std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return values[i] > values[j]; }); };
  by(found.responses);
  order.resize(std::min<std::size_t>(order.size(), max_features));
  by(found.sizes_px);
  for (int index : order)
  {
    // Halved images share the corners of their pixels, not the centres.
    const cv::Point2f HALF(0.5F, 0.5F);
    const cv::Point2f pixel = factor * (found.pixels[index] + HALF) - HALF + corner;
    Feature feature;
    feature.pixel = { pixel.x, pixel.y };
    feature.scale_px = factor * found.sizes_px[index];
    feature.depth_m = depthUnder(frame, pixel);
    feature.p_camera = frame.camera.unproject(pixel.x, pixel.y, feature.depth_m);
    result.features.push_back(feature);
    result.descriptors.push_back(found.descriptors.row(index));
  }
  return result;
}

std::vector<DescriptorMatch> matchFeatures(const KeyframeFeatures& a, const KeyframeFeatures& b, double max_ratio,
                                           int first_a, int first_b)
{
  const auto first = [](const cv::Mat& descriptors, int count)
  { return count > 0 && count < descriptors.rows ? descriptors.rowRange(0, count) : descriptors; };
  return matchDescriptors(first(a.descriptors, first_a), first(b.descriptors, first_b), a.norm, max_ratio);
}

}  // namespace object_modelling::features
