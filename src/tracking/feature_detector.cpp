#include "feature_detector.h"

#include <opencv2/imgproc.hpp>

namespace object_modelling::tracking
{
std::vector<Eigen::Vector2f> detectFeatures(const cv::Mat& gray, const cv::Mat& allowed,
                                            const std::vector<Eigen::Vector2f>& occupied,
                                            const FeatureDetectorOptions& options)
{
  const int wanted = options.max_features - static_cast<int>(occupied.size());
  if (wanted <= 0 || gray.cols <= 2 * options.border_px || gray.rows <= 2 * options.border_px)
    return {};
  cv::Mat mask(gray.size(), CV_8UC1, cv::Scalar(0));
  const cv::Rect inner(options.border_px, options.border_px, gray.cols - 2 * options.border_px,
                       gray.rows - 2 * options.border_px);
  if (allowed.empty())
    mask(inner).setTo(255);
  else
    allowed(inner).copyTo(mask(inner));
  for (const Eigen::Vector2f& pixel : occupied)
    cv::circle(mask, cv::Point(cvRound(pixel.x()), cvRound(pixel.y())), options.min_distance_px, cv::Scalar(0),
               cv::FILLED);
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(gray, corners, wanted, options.quality_ratio, options.min_distance_px, mask, 5);
  std::vector<Eigen::Vector2f> features;
  features.reserve(corners.size());
  for (const cv::Point2f& corner : corners)
    features.emplace_back(corner.x, corner.y);
  return features;
}

}  // namespace object_modelling::tracking
