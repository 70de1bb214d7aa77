#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::calibration
{
/// A square of pixels on the wall, small enough that distortion is a slope on it.
struct WallBlock
{
  double u_px = 0, v_px = 0;  ///< centre
  double z_m = 0;
  double theta_rad = 0;
  double sigma_m = 0;       ///< of its pixels about a plane of the block's own
  double offset_ratio = 0;  ///< measured depth at the centre, over that of the frame's plane, minus 1
};

/// One frame of a wall.
struct WallView
{
  double stamp_s = 0;
  /// 1 / z = w . (x, y, 1) for the ray (x, y, 1) of a pixel.
  Eigen::Vector3d inverse_plane = Eigen::Vector3d::Zero();
  double noise_m = 0;  ///< robust standard deviation of the wall's depth about the plane
  cv::Mat region;      ///< CV_8UC1, 255 where the frame shows the wall, with its rim
  std::vector<WallBlock> blocks;

  double distance_m() const { return 1 / inverse_plane.norm(); }
  double depthAt_m(double x, double y) const { return 1 / inverse_plane.dot(Eigen::Vector3d(x, y, 1)); }
  double theta_rad(double x, double y) const;
};

/// NO_RESULT with the reason in a few words that are the same for all frames with that fault.
base::Result<WallView> viewWall(const rgbd::Frame& frame, double min_wall_ratio);

}  // namespace object_modelling::calibration
