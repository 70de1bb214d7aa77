#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
enum DepthEdge : std::uint8_t
{
  NO_EDGE = 0,
  OCCLUDING = 1,     ///< nearer side of a depth step
  OCCLUDED = 2,      ///< farther side
  MISSING_DATA = 4,  ///< next to pixels without depth
};

struct DepthEdgeOptions
{
  double step_ratio = 0.02;  ///< a step is an edge if it exceeds this share of the nearer depth
  std::vector<std::string> violations() const;
};

/// CV_8UC1 with a combination of DepthEdge per pixel (4-neighbourhood); 0 also where depth is missing. The rim of the
/// image is no edge.
cv::Mat findDepthEdges(const Frame& frame, const DepthEdgeOptions& options = {});

/// CV_32FC1: distance in px of each pixel to the nearest edge of the given kinds; width + height if there is
/// no such edge.
cv::Mat distanceToEdges_px(const cv::Mat& edges, int kinds = OCCLUDING | OCCLUDED | MISSING_DATA);

}  // namespace object_modelling::rgbd
