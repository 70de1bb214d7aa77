#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/projection.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::fusion
{
/// A view prepared for looking up what it measured where a point projects.
struct PreparedView
{
  const rgbd::Frame* frame = nullptr;
  Eigen::Isometry3f T_camera_world = Eigen::Isometry3f::Identity();
  Eigen::Vector3f p_world_camera = Eigen::Vector3f::Zero();  ///< centre of projection
  Eigen::Vector2f color_offset_px = Eigen::Vector2f::Zero();
  /// Nearest depth within a pixel's 8 neighbours, infinite where none has depth: a surface that may be displaced by the
  /// lateral noise of a pixel still counts as there.
  cv::Mat nearest_depth_m;
};

std::vector<PreparedView> prepareViews(const std::vector<rgbd::View>& views);

/// Whether a frame brings a mask with anything in it.
bool hasObject(const rgbd::Frame& frame);

inline geometry::Projection<float> project(const PreparedView& view, const Eigen::Vector3f& p_world)
{
  const Eigen::Vector3f p_camera = view.T_camera_world * p_world;
  return geometry::projectionOf(view.frame->camera, p_camera);
}

}  // namespace object_modelling::fusion
