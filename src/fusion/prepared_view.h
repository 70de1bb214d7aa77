#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

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

/// Where a point falls in a view.
struct Projection
{
  bool inside = false;  ///< in front of the camera and within the image
  float u_px = 0, v_px = 0, z_m = 0;
  int column = 0, row = 0;  ///< pixel
};

inline Projection project(const PreparedView& view, const Eigen::Vector3f& p_world)
{
  Projection result;
  const Eigen::Vector3f p_camera = view.T_camera_world * p_world;
  if (!(p_camera.z() > 0))
    return result;
  const geometry::PinholeCamera& camera = view.frame->camera;
  result.z_m = p_camera.z();
  result.u_px = static_cast<float>(camera.fx) * p_camera.x() / p_camera.z() + static_cast<float>(camera.cx);
  result.v_px = static_cast<float>(camera.fy) * p_camera.y() / p_camera.z() + static_cast<float>(camera.cy);
  result.inside = result.u_px > -0.5f && result.v_px > -0.5f && result.u_px < static_cast<float>(camera.width) - 0.5f &&
                  result.v_px < static_cast<float>(camera.height) - 0.5f;
  if (result.inside)
  {
    result.column = cvRound(result.u_px);
    result.row = cvRound(result.v_px);
  }
  return result;
}

}  // namespace object_modelling::fusion
