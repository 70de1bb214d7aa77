#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "plane_growing.h"

namespace object_modelling::segmentation
{
/// The convex outline of the visible part of a plane. What stands over it may rest on it; what does not (a wall or a
/// chair beyond the table's edge) is background.
class SupportExtent
{
public:
  SupportExtent(const WorkingImage& image, const GrownPlanes& planes, int index);

  /// Whether the foot of the perpendicular from the point lies inside the outline, or outside by at most `margin_m`.
  bool carries(const Eigen::Vector3d& p_camera, double margin_m) const;
  /// Share of the pixels of a mask that stand over the outline; a sample of them is looked at.
  double carriedRatio(const rgbd::Frame& frame, const cv::Mat& mask, const cv::Rect& rect, double margin_m) const;

private:
  cv::Point2f onPlane(const Eigen::Vector3d& p_camera) const;

  Eigen::Vector3d x_axis_, y_axis_;
  std::vector<cv::Point2f> outline_;  // in plane coordinates, m
};

}  // namespace object_modelling::segmentation
