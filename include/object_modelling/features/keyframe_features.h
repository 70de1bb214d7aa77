#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/features/described_points.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::features
{
struct Feature
{
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();     ///< sub-pixel
  double scale_px = 0;                                 ///< diameter of the described patch's centre blob
  double depth_m = 0;                                  ///< NaN where missing or at a depth step
  Eigen::Vector3d p_camera = Eigen::Vector3d::Zero();  ///< back-projected; NaN without depth
};

/// Features of one keyframe, largest scale first.
struct KeyframeFeatures
{
  std::vector<Feature> features;
  cv::Mat descriptors;  ///< CV_32FC1 (SIFT) or CV_8UC1 (AKAZE), one row per feature
  int norm = 0;         ///< cv::NormTypes that fits the descriptors
};

/// Those of detectScaleInvariant(), at most `max_features` by response. With `object_only`, only well inside the object
/// mask: a patch across the silhouette describes the background too.
KeyframeFeatures detectFeatures(const rgbd::Frame& frame, int max_features, bool object_only);

/// matchDescriptors() of two keyframes, as indices into their features. Uses the first `first_a`, `first_b` features
/// (those of the largest scale) only; all if 0.
std::vector<DescriptorMatch> matchFeatures(const KeyframeFeatures& a, const KeyframeFeatures& b, double max_ratio,
                                           int first_a = 0, int first_b = 0);

}  // namespace object_modelling::features
