#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace object_modelling::features
{
/// Points of an image that are found again from elsewhere. All but the norm have one entry, or row, per point.
struct DescribedPoints
{
  std::vector<cv::Point2f> pixels;  ///< (0, 0) is the centre of the upper left pixel
  std::vector<float> sizes_px;      ///< diameter of the described patch's centre blob
  std::vector<float> responses;     ///< strength of the detector at the point; comparable within one detector
  cv::Mat descriptors;              ///< CV_32FC1 (SIFT) or CV_8UC1 (AKAZE, ORB)
  int norm = 0;                     ///< cv::NormTypes for comparing the descriptors
};

/// Found from other directions and distances: SIFT (in OpenCV's main module from 4.4 on; AKAZE before), at most about
/// `max_points` by response, on the mask, or everywhere where that is empty. Their pixels are free of the 0.25 px by
/// which OpenCV's SIFT puts them too far right and down.
DescribedPoints detectScaleInvariant(const cv::Mat& gray, const cv::Mat& mask, int max_points);

/// Found from not far off, in a tenth of the time: ORB.
DescribedPoints detectQuick(const cv::Mat& gray, const cv::Mat& mask, int max_points);

/// Two descriptors that name one point, as rows.
struct DescriptorMatch
{
  int a = -1, b = -1;
};

/// Mutual nearest neighbours that pass the ratio test (Lowe, Distinctive Image Features from Scale-Invariant Keypoints,
/// IJCV 2004, section 7.1) in both directions, by `a`. Both of one detector; none where either has fewer than two rows.
std::vector<DescriptorMatch> matchDescriptors(const cv::Mat& a, const cv::Mat& b, int norm, double max_ratio);

}  // namespace object_modelling::features
