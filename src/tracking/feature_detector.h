#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::tracking
{
struct FeatureDetectorOptions
{
  int max_features = 600;
  int min_distance_px = 7;      ///< between features, old and new
  double quality_ratio = 0.01;  ///< of the strongest corner's smaller eigenvalue (Shi & Tomasi 1994)
  int border_px = 12;           ///< a patch round the feature must lie inside the image
};

/// Corners of `gray` (CV_8UC1) where `allowed` (CV_8UC1, may be empty) is set, away from the `occupied` positions; the
/// strongest first, as many as `max_features` leaves room for beside those.
std::vector<Eigen::Vector2f> detectFeatures(const cv::Mat& gray, const cv::Mat& allowed,
                                            const std::vector<Eigen::Vector2f>& occupied,
                                            const FeatureDetectorOptions& options);

}  // namespace object_modelling::tracking
