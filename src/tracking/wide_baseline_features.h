#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "object_modelling/features/described_points.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::tracking
{
enum class FeatureKind
{
  QUICK,   ///< ORB: some ten milliseconds a frame, for views not far from a known one
  ROBUST,  ///< SIFT (AKAZE before OpenCV 4.4): ten times as long, for wide steps
};

/// Features that are recognised from other directions and distances, with their points where there is depth.
struct WideBaselineFeatures
{
  std::vector<Eigen::Vector2f> pixels;
  std::vector<float> depths_m;  ///< NaN where missing
  cv::Mat descriptors;          ///< one row each
  int norm = 0;                 ///< cv::NormTypes for comparing descriptors
};

/// On the frame's object mask, or on all of it where it has none.
WideBaselineFeatures detectWideBaselineFeatures(const rgbd::Frame& frame, FeatureKind kind);

/// Of one kind: those that matchDescriptors() finds.
std::vector<features::DescriptorMatch> matchFeatures(const WideBaselineFeatures& a, const WideBaselineFeatures& b);

}  // namespace object_modelling::tracking
