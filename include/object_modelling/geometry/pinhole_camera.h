#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace object_modelling::geometry
{
/// Intrinsics of one image. Pixel (0, 0) is the centre of the upper left pixel; the optical frame has x right, y down,
/// z forward. There is no default camera anywhere: intrinsics always come from the sensor's CameraInfo or camera.yaml.
struct PinholeCamera
{
  int width = 0;                          ///< px
  int height = 0;                         ///< px
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  /// Brown-Conrady k1 k2 p1 p2 k3 [k4 k5 k6] as in sensor_msgs/CameraInfo "plumb_bob" (5) and "rational_polynomial"
  /// (8); empty or all zero for a rectified image. Everything above `rgbd` sees rectified images only.
  std::vector<double> distortion;

  bool distorted() const;

  /// All reasons why this camera cannot be used (non-positive size or focal length, NaN, odd distortion length).
  std::vector<std::string> violations() const;

  /// Pixel of a point in the optical frame, without distortion. Undefined for z <= 0.
  Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const
  {
    return { fx * p_camera.x() / p_camera.z() + cx, fy * p_camera.y() / p_camera.z() + cy };
  }
  /// Point in the optical frame at depth z (m) on the ray of a (rectified) pixel.
  Eigen::Vector3d unproject(double u_px, double v_px, double z_m) const
  {
    return { (u_px - cx) / fx * z_m, (v_px - cy) / fy * z_m, z_m };
  }
  /// Whether a pixel lies inside the image, at least `border_px` from its rim.
  bool contains(const Eigen::Vector2d& pixel, double border_px = 0) const
  {
    return pixel.x() >= border_px && pixel.y() >= border_px && pixel.x() <= width - 1 - border_px &&
           pixel.y() <= height - 1 - border_px;
  }
  /// The same view at another resolution: pixel areas scale, so centres shift by half a pixel.
  PinholeCamera scaled(double factor) const;
};

bool operator==(const PinholeCamera& a, const PinholeCamera& b);

}  // namespace object_modelling::geometry
