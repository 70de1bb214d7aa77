#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/projection.h"
#include "object_modelling/multi_view_icp/multi_view_icp.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::multi_view_icp
{
constexpr int ICP_COLOR_LEVELS = 3;

/// A point of a view that looks for partners, in its camera frame.
struct IcpPoint
{
  Eigen::Vector3f p = Eigen::Vector3f::Zero();
  Eigen::Vector3f n = Eigen::Vector3f::Zero();  ///< unit, towards the camera
  float sigma_m = 0;                            ///< of its place along n
  cv::Vec<float, ICP_COLOR_LEVELS> intensity;
};

/// One colour image at a reduced resolution.
struct IcpImage
{
  cv::Mat gray;  ///< CV_8UC1
  float fx = 1, fy = 1, cx = 0, cy = 0;
};

/// What multi-view ICP needs of a view: surface at no more than 320 px of width, grey levels there and at a half
/// and a quarter of it, points.
class IcpView
{
public:
  IcpView(const rgbd::View& view, const MultiViewIcpOptions& options);

  /// Where surface and normal are known, no depth edge is near and, if only the object counts, its mask is set.
  bool has(int u, int v) const { return usable_.at<std::uint8_t>(v, u) != 0; }
  Eigen::Vector3f point(int u, int v) const
  {
    const float z = depth_m_.at<float>(v, u);
    return { (static_cast<float>(u) - fx_cx_.y()) / fx_cx_.x() * z,
             (static_cast<float>(v) - fy_cy_.y()) / fy_cy_.x() * z, z };
  }
  Eigen::Vector3f normal(int u, int v) const
  {
    const auto& n = normals_.at<cv::Vec3f>(v, u);
    return { n[0], n[1], n[2] };
  }
  /// Depth (m) whatever the normal and the mask; NaN where missing.
  float depth_m(int u, int v) const { return depth_m_.at<float>(v, u); }
  geometry::Projection<float> project(const Eigen::Vector3f& p) const { return geometry::projectionOf(camera_, p); }
  /// Compared in double: depth plus tolerance would round where the difference of two depths does not.
  rgbd::Visibility visibilityOf(const geometry::Projection<float>& at, double tolerance_m) const
  {
    return rgbd::visibilityOf(at, depth_m_, tolerance_m);
  }
  cv::Size size() const { return depth_m_.size(); }
  float focal_px() const { return fx_cx_.x(); }
  /// Sigma (m) along the normal of a point of a surface, from noise model and what averaging does not remove.
  float surfaceSigma_m(const Eigen::Vector3f& p, const Eigen::Vector3f& n) const;

  const std::vector<IcpPoint>& surfacePoints() const { return surface_points_; }
  const std::vector<IcpPoint>& colorPoints() const { return color_points_; }
  /// On the nearer side of depth steps, in the camera frame.
  const std::vector<Eigen::Vector3f>& rimPoints() const { return rim_points_; }
  const std::vector<IcpImage>& images() const { return images_; }  ///< finest first; empty without grey image

private:
  void choosePoints(int count);
  void chooseRims(const cv::Mat& mask);
  IcpPoint pointAt(int u, int v) const;

  geometry::PinholeCamera camera_;  ///< of depth_m_
  Eigen::Vector2f fx_cx_, fy_cy_;   ///< the same in the precision of the points
  rgbd::SensorNoiseModel noise_model_;
  cv::Mat depth_m_, normals_, usable_;
  std::vector<IcpImage> images_;
  std::vector<IcpPoint> surface_points_, color_points_;
  std::vector<Eigen::Vector3f> rim_points_;
};

}  // namespace object_modelling::multi_view_icp
