#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/evaluation/comparison.h"

namespace object_modelling::evaluation
{
/// Points (and triangles, if the file has any) of a .ply (float or double), .obj or .pcd file, times `unit_m`. Corners
/// that no triangle uses are kept. Throws base::Error (NOT_FOUND, BAD_INPUT, INVALID_ARGUMENT for another extension).
mesh::TriangleMesh readGeometry(const std::string& path, double unit_m = 1);

/// 4x4, row by row, white space between the numbers. Throws base::Error (NOT_FOUND; BAD_INPUT: not 16 numbers, not
/// rigid).
Eigen::Isometry3d readTransform(const std::string& path);
void writeTransform(const std::string& path, const Eigen::Isometry3d& T_target_source);

struct Histogram
{
  double bin_width_m = 0;
  std::vector<std::size_t> counts;  ///< the last bin holds all distances beyond too
};
Histogram histogramOf(const std::vector<double>& distances_m, double bin_width_m, std::size_t bin_count);
/// Bars over millimetres with mean and sigma, CV_8UC3.
cv::Mat drawHistogram(const Histogram& histogram, const DistanceStatistics& statistics);
void writeHistogram(const std::string& path, const Histogram& histogram, const DistanceStatistics& statistics);

/// Binary PLY of the placed points, blue where they lie on the reference to red at `red_from_m` and beyond. All
/// writers throw base::Error (STORAGE); a file appears whole or not at all.
void writeColoredCloud(const std::string& path, const Comparison& comparison, double red_from_m);

}  // namespace object_modelling::evaluation
