#include "object_modelling/features/described_points.h"

#include <opencv2/core/version.hpp>
#include <opencv2/features2d.hpp>

namespace object_modelling::features
{
namespace
{
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 4)
// SIFT starts from an image of twice the size but maps its pixel centres back as x / 2, not (x + 1/2) / 2 - 1/2
// (measured on Gaussian blobs: +0.24 px in x and y at any scale).
const cv::Point2f SCALE_INVARIANT_OFFSET_PX(0.25F, 0.25F);
cv::Ptr<cv::Feature2D> makeScaleInvariant(int max_points)
{
  constexpr int LAYERS = 3;
  constexpr double MIN_CONTRAST = 0.02;
  return cv::SIFT::create(max_points, LAYERS, MIN_CONTRAST);
}
#else
const cv::Point2f SCALE_INVARIANT_OFFSET_PX(0, 0);
cv::Ptr<cv::Feature2D> makeScaleInvariant(int /*max_points*/)
{
  constexpr float MIN_RESPONSE = 5e-4F;
  return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, MIN_RESPONSE);
}
#endif

DescribedPoints detect(cv::Feature2D& detector, const cv::Mat& gray, const cv::Mat& mask, const cv::Point2f& offset_px)
{
  DescribedPoints result;
  result.norm = detector.defaultNorm();
  std::vector<cv::KeyPoint> keypoints;
  detector.detectAndCompute(gray, mask, keypoints, result.descriptors);
  for (const cv::KeyPoint& keypoint : keypoints)
  {
    result.pixels.push_back(keypoint.pt - offset_px);
    result.sizes_px.push_back(keypoint.size);
    result.responses.push_back(keypoint.response);
  }
  return result;
}
}  // namespace

DescribedPoints detectScaleInvariant(const cv::Mat& gray, const cv::Mat& mask, int max_points)
{
  return detect(*makeScaleInvariant(max_points), gray, mask, SCALE_INVARIANT_OFFSET_PX);
}

DescribedPoints detectQuick(const cv::Mat& gray, const cv::Mat& mask, int max_points)
{
  constexpr float LEVEL_SCALE = 1.3F;
  constexpr int LEVELS = 6, BORDER_PX = 20, PATCH_PX = 31, FAST_THRESHOLD = 12;
  return detect(*cv::ORB::create(max_points, LEVEL_SCALE, LEVELS, BORDER_PX, 0, 2, cv::ORB::HARRIS_SCORE, PATCH_PX,
                                 FAST_THRESHOLD),
                gray, mask, {});
}

}  // namespace object_modelling::features
