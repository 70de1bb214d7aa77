#pragma once

#include <vector>

#include <Eigen/Geometry>

namespace object_modelling::geometry
{
/// Box centred at the origin of its own frame; T_frame_box places it.
struct OrientedBox
{
  Eigen::Isometry3d T_frame_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< full edge lengths along the box's x, y, z

  bool contains(const Eigen::Vector3d& p_frame) const;
};

/// Smallest box with its z axis along `up`: the minimum-area rectangle of the points' footprint (rotating calipers),
/// x along its longer side, times their extent along `up`. Throws base::Error (BAD_INPUT) for no points.
/// `trim_ratio` in [0, 0.5): share of points ignored at either end of every axis, against stray points.
OrientedBox boxAlong(const Eigen::Vector3d& up, const std::vector<Eigen::Vector3f>& points, double trim_ratio = 0);

/// Smallest of the boxes that stand on a face of the points' convex hull; for objects without a known support plane.
OrientedBox smallestBox(const std::vector<Eigen::Vector3f>& points, double trim_ratio = 0);

}  // namespace object_modelling::geometry
