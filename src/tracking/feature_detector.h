#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "object_modelling/registration/image_pyramid.h"

namespace object_modelling::tracking
{
struct FeatureDetectorOptions
{
  int max_features = 600;
  int min_distance_px = 7;      ///< between features, old and new
  double quality_ratio = 0.01;  ///< of the strongest corner's smaller eigenvalue (Shi & Tomasi 1994)
  int border_px = 12;           ///< a patch round the feature must lie inside the image
  double min_gradient = 3;      ///< grey levels per pixel, in the weaker direction
  int block_px = 5;             ///< window of the eigenvalue
};

/// Corners of `gray` (CV_8UC1) where `allowed` (CV_8UC1, may be empty) is set, away from the `occupied` positions; the
/// strongest first, as many as `max_features` leaves room for beside those.
std::vector<Eigen::Vector2f> detectFeatures(const cv::Mat& gray, const cv::Mat& allowed,
                                            const std::vector<Eigen::Vector2f>& occupied,
                                            const FeatureDetectorOptions& options);

/// The same on the next level of the pyramid for images larger than about 400 px, four times as fast: a patch can be
/// found again wherever there is texture, it need not sit on the corner exactly. Positions are of the full resolution.
std::vector<Eigen::Vector2f> detectFeatures(const registration::ImagePyramid& pyramid, const cv::Mat& allowed,
                                            const std::vector<Eigen::Vector2f>& occupied,
                                            const FeatureDetectorOptions& options);

}  // namespace object_modelling::tracking
