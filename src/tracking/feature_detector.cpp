#include "feature_detector.h"

#include <opencv2/imgproc.hpp>

namespace object_modelling::tracking
{
namespace
{
/// What cv::cornerMinEigenVal() gives where the weaker of the two gradients is `gradient` grey levels per pixel (root
/// mean square): its 3 x 3 Sobel kernels sum to 8, and it divides by 4 and 255.
double eigenvalueOf(double gradient)
{
  const double scaled = gradient * 8 / (4 * 255.0);
  return scaled * scaled;
}
}  // namespace

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
  // Noise and the blocks of compressed images have corners too, which stand still in the image.
  cv::Mat eigenvalues;
  cv::cornerMinEigenVal(gray, eigenvalues, options.block_px);
  mask.setTo(0, eigenvalues < eigenvalueOf(options.min_gradient));
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(gray, corners, wanted, options.quality_ratio, options.min_distance_px, mask,
                          options.block_px);
  std::vector<Eigen::Vector2f> features;
  features.reserve(corners.size());
  for (const cv::Point2f& corner : corners)
    features.emplace_back(corner.x, corner.y);
  return features;
}

std::vector<Eigen::Vector2f> detectFeatures(const registration::ImagePyramid& pyramid, const cv::Mat& allowed,
                                            const std::vector<Eigen::Vector2f>& occupied,
                                            const FeatureDetectorOptions& options)
{
  constexpr int MAX_WIDTH = 400;
  const std::vector<cv::Mat>& levels = pyramid.levels();
  if (levels[0].cols <= MAX_WIDTH || levels.size() < 2)
    return detectFeatures(levels[0], allowed, occupied, options);
  cv::Mat half_allowed;
  if (!allowed.empty())
    cv::resize(allowed, half_allowed, levels[1].size(), 0, 0, cv::INTER_NEAREST);
  std::vector<Eigen::Vector2f> half_occupied;
  half_occupied.reserve(occupied.size());
  for (const Eigen::Vector2f& pixel : occupied)
    half_occupied.emplace_back(pixel / 2);
  FeatureDetectorOptions half = options;
  half.min_distance_px = (options.min_distance_px + 1) / 2;
  half.border_px = (options.border_px + 1) / 2;
  half.block_px = (options.block_px + 1) / 2;
  // Averaging has taken the noise away, so that weaker corners are real ones.
  half.quality_ratio = options.quality_ratio / 4;
  std::vector<Eigen::Vector2f> features = detectFeatures(levels[1], half_allowed, half_occupied, half);
  // cv::pyrDown puts pixel u of a level on pixel 2 u of the level below.
  for (Eigen::Vector2f& pixel : features)
    pixel *= 2;
  return features;
}

}  // namespace object_modelling::tracking
