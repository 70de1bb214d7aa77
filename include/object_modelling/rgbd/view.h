#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
/// A frame, and where it was taken from: what a call takes that works on images from several places, of one session or
/// of several. The world is a frame common to all views of a call, which the caller chooses. Copying a view copies no
/// pixels.
struct View
{
  Frame frame;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< of the depth image's camera
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();        ///< of T_world_camera; zero where not known
  /// From 0: views of one session show the object in one place, under one light.
  int session_index = 0;
  /// Pixel of a point in the colour image minus its pixel in the depth image (SensorCalibration::color_offset_px of its
  /// session, bundle_adjustment::BundleAdjustmentResult); zero where not known.
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
};

/// Whether its pose and colour offset are finite and its session has a number.
bool isPlaced(const View& view);

/// Throws base::Error (INVALID_ARGUMENT) that names the first view that is not placed.
void checkPlaced(const std::vector<View>& views);

/// Brings a view into another world, its covariance with it.
void transform(const Eigen::Isometry3d& T_target_world, View* view);

}  // namespace object_modelling::rgbd
