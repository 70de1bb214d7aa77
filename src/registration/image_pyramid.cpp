#include "object_modelling/registration/image_pyramid.h"

#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace object_modelling::registration
{
namespace
{
constexpr int FLOW_LEVELS = 4;
const cv::Size WINDOW(15, 15);
constexpr double MIN_EIGENVALUE = 1e-4;
constexpr float BORDER_PX = 8;
}  // namespace

ImagePyramid::ImagePyramid(const cv::Mat& gray)
{
  const int built = cv::buildOpticalFlowPyramid(gray, levels_, WINDOW, FLOW_LEVELS, false);
  levels_.resize(static_cast<std::size_t>(built) + 1);
}

std::vector<cv::Mat> ImagePyramid::copyLevels() const
{
  std::vector<cv::Mat> copies;
  for (const cv::Mat& level : levels_)
    copies.push_back(level.clone());
  return copies;
}

double ImagePyramid::sharpness(const cv::Mat& mask) const
{
  const cv::Mat& half = levels_[levels_.size() > 1 ? 1 : 0];
  cv::Mat laplacian, half_mask;
  cv::Laplacian(half, laplacian, CV_16S);
  if (mask.empty())
    return cv::norm(laplacian, cv::NORM_L1) / static_cast<double>(half.total());
  cv::resize(mask, half_mask, half.size(), 0, 0, cv::INTER_NEAREST);
  return cv::norm(laplacian, cv::NORM_L1, half_mask) / std::max(1, cv::countNonZero(half_mask));
}

std::vector<FlowFeature> trackFlow(const ImagePyramid& last, const ImagePyramid& current,
                                   const std::vector<Eigen::Vector2f>& pixels,
                                   const std::vector<Eigen::Vector2f>& predicted)
{
  std::vector<FlowFeature> features(pixels.size());
  if (pixels.empty())
    return features;
  std::vector<cv::Point2f> from, to;
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    from.emplace_back(pixels[i].x(), pixels[i].y());
    to.emplace_back(predicted[i].x(), predicted[i].y());
  }
  std::vector<unsigned char> found;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(last.levels(), current.levels(), from, to, found, errors, WINDOW, FLOW_LEVELS,
                           cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 15, 0.03),
                           cv::OPTFLOW_USE_INITIAL_FLOW, MIN_EIGENVALUE);
  const cv::Size size = current.levels()[0].size();
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    const bool inside = to[i].x >= BORDER_PX && to[i].y >= BORDER_PX &&
                        to[i].x < static_cast<float>(size.width) - BORDER_PX &&
                        to[i].y < static_cast<float>(size.height) - BORDER_PX;
    features[i] = { found[i] != 0 && inside, { to[i].x, to[i].y } };
  }
  return features;
}

}  // namespace object_modelling::registration
