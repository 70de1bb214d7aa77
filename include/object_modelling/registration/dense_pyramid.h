#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::registration
{
/// One frame at a reduced resolution. Pixel u of it lies on pixel step * u of the frame.
struct DenseLevel
{
  int step = 1;
  float fx = 1, fy = 1, cx = 0, cy = 0;  ///< px of this level
  cv::Mat gray;                          ///< CV_8UC1
  cv::Mat depth_m;                       ///< CV_32FC1, NaN where missing; mean over the neighbours on the same surface
  cv::Mat mask;                          ///< CV_8UC1: what counts; empty: all
  rgbd::SensorNoiseModel noise_model;    ///< of the frame
};

/// What dense alignment needs of a frame: grey and depth at a quarter, an eighth and a sixteenth of VGA, finest first.
class DensePyramid
{
public:
  DensePyramid() = default;
  /// `gray_levels`: full resolution first, each half of the one before (cv::pyrDown).
  DensePyramid(const rgbd::Frame& frame, const std::vector<cv::Mat>& gray_levels);

  const std::vector<DenseLevel>& levels() const { return levels_; }

private:
  std::vector<DenseLevel> levels_;
};

/// A point of a reference frame, in metres in that camera's optical frame.
struct DensePoint
{
  Eigen::Vector3f p;
  Eigen::Vector3f n;      ///< towards the camera; zero where unknown: no depth residual
  float intensity = 0;    ///< grey level, 0 to 255
  bool textured = false;  ///< enough gradient for an intensity residual
};

/// Points of one level, on a grid and on grey-level edges.
struct DensePoints
{
  std::vector<DensePoint> all;
  double pixels_per_point = 1;  ///< so many pixels of the finest level stand behind each point with a normal
  double edges_per_point = 1;   ///< so many pixels of edges stand behind each textured point
};

/// Points of one frame, level by level as in its DensePyramid.
class DenseReference
{
public:
  explicit DenseReference(const DensePyramid& pyramid);
  const std::vector<DensePoints>& levels() const { return levels_; }

private:
  std::vector<DensePoints> levels_;
};

}  // namespace object_modelling::registration
