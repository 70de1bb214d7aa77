#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::registration
{
/// Grey pyramid of one frame, made once for optical flow, patch refinement and dense alignment.
class ImagePyramid
{
public:
  ImagePyramid() = default;
  explicit ImagePyramid(const cv::Mat& gray);

  bool empty() const { return levels_.empty(); }
  /// Full resolution first; as cv::buildOpticalFlowPyramid makes them, with a border round each.
  const std::vector<cv::Mat>& levels() const { return levels_; }
  /// Copy without borders, for keeping.
  std::vector<cv::Mat> copyLevels() const;
  /// Mean absolute Laplacian at half resolution: what blur takes away. Over `mask` (full resolution) if not empty.
  double sharpness(const cv::Mat& mask) const;

private:
  std::vector<cv::Mat> levels_;
};

struct FlowFeature
{
  bool found = false;
  Eigen::Vector2f pixel{ 0, 0 };  ///< sub-pixel, at full resolution
};

/// Where features of the last frame are in the current one (KLT, Bouguet's pyramid), started from `predicted`.
std::vector<FlowFeature> trackFlow(const ImagePyramid& last, const ImagePyramid& current,
                                   const std::vector<Eigen::Vector2f>& pixels,
                                   const std::vector<Eigen::Vector2f>& predicted);

}  // namespace object_modelling::registration
