#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
struct NormalOptions
{
  int radius_px = 4;                    ///< half window
  double max_depth_step_ratio = 0.015;  ///< a neighbour further than this share of depth is another surface
  int min_neighbors = 8;                ///< of the same surface (near edges every other pixel is counted)
  std::vector<std::string> violations() const;
};

/// Unit normals in the optical frame facing the camera, CV_32FC3, NaN where depth is missing or too few neighbours
/// belong to the same surface. Least-squares plane per window, fitted to inverse depth: there a plane is a linear
/// function of the pixel, and the noise of a disparity-measuring sensor has one sigma everywhere.
cv::Mat computeNormals(const Frame& frame, const NormalOptions& options = {});

}  // namespace object_modelling::rgbd
