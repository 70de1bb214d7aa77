#include "object_modelling/features/keyframe_features.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace object_modelling::features
{
namespace
{
const std::vector<Eigen::Vector2d> BLOBS = { { 100, 90 }, { 433.3, 250.7 }, { 700.5, 120 }, { 880, 600.25 } };

/// Bright blobs of known centres before a plain wall at 1 m.
rgbd::Frame blobs(int width, int height, double sigma_px)
{
  rgbd::Frame frame;
  frame.camera = { width, height, 525, 525, 0.5 * (width - 1), 0.5 * (height - 1), {} };
  cv::Mat gray(height, width, CV_32FC1, cv::Scalar(40));
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (const Eigen::Vector2d& blob : BLOBS)
        gray.at<float>(v, u) += static_cast<float>(
            180 * std::exp(-0.5 * (Eigen::Vector2d(u, v) - blob).squaredNorm() / (sigma_px * sigma_px)));
  gray.convertTo(frame.gray, CV_8U);
  frame.depth_m = cv::Mat(height, width, CV_32FC1, cv::Scalar(1));
  return frame;
}

TEST(KeyframeFeatures, LieWhereTheBlobsAreThoughImagesAreHalved)
{
  // Odd at the first or the second halving; small enough for none.
  for (const cv::Size size : { cv::Size(1001, 701), cv::Size(1002, 702), cv::Size(1000, 700) })
  {
    const KeyframeFeatures features = detectFeatures(blobs(size.width, size.height, 10), 100, false);
    for (const Eigen::Vector2d& blob : BLOBS)
    {
      double nearest_px = 1e9;
      for (const Feature& feature : features.features)
        nearest_px = std::min(nearest_px, (feature.pixel - blob).norm());
      EXPECT_LT(nearest_px, 0.25) << size << " " << blob.transpose();
    }
  }
}

}  // namespace
}  // namespace object_modelling::features
