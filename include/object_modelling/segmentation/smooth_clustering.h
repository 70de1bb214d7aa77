#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/geometry/plane.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::segmentation
{
struct HeightLimits
{
  double min_m = 0.003;
  double noise_sigmas = 2.0;  ///< added to min_m: so many axial sigmas, seen along the plane's normal
  double max_m = 0.6;
  double max_distance_m = 2.0;  ///< along the optical axis
};

enum Foreground : std::uint8_t
{
  BELOW = 0,
  LOW = 128,   ///< above half of the height limit: object if it continues an object's foot
  HIGH = 255,  ///< higher than table and noise can explain
};

/// CV_8UC1 of Foreground: how a pixel stands above the plane (in the camera frame). Lone pixels that fly between a
/// silhouette and what lies behind it are BELOW. Only within `area` (empty: everywhere).
cv::Mat pixelsAbove(const rgbd::Frame& frame, const geometry::Plane& plane_camera, const HeightLimits& limits,
                    double depth_step_ratio, const cv::Rect& area = {});

struct Cluster
{
  int label = 0;  ///< in Clusters::labels
  int pixel_count = 0;
  cv::Rect rect;
};

struct Clusters
{
  cv::Mat labels;                 ///< CV_32SC1; 0: none
  std::vector<Cluster> clusters;  ///< most pixels first; smaller ones than asked for keep their labels but are not here

  cv::Mat mask(const Cluster& cluster) const;
};

/// Connected components of the HIGH foreground: neighbours are connected whose depths differ by less than a share of
/// their depth, also across gaps of up to 2 px without depth. They then grow by the LOW pixels of their foot. Linear in
/// the number of pixels.
Clusters clusterSmooth(const rgbd::Frame& frame, const cv::Mat& foreground, double depth_step_ratio, int min_pixels);

}  // namespace object_modelling::segmentation
