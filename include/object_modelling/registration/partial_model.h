#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/pinhole_camera.h"
#include "object_modelling/geometry/plane.h"

namespace object_modelling::registration
{
/// Space observed by one view: empty up to the measured depth.
struct SpaceView
{
  geometry::PinholeCamera camera;
  Eigen::Isometry3f T_camera_session = Eigen::Isometry3f::Identity();
  /// CV_32FC1: the least depth of each pixel and its neighbours, 0 where one of them is missing (nothing is known).
  cv::Mat least_depth_m;
  double axial_sigma_m = 0;  ///< at the object
};

/// Features of one view that lie on the object.
struct ObjectFeatures
{
  std::vector<Eigen::Vector3f> points;  ///< session frame
  cv::Mat descriptors;                  ///< one row per point
  int norm = 0;                         ///< cv::NormTypes for comparing them
};

/// The part of an object's surface that one session saw, thinned for matching. Points, normals and both colours have
/// the same length; metres, session frame.
struct PartialModel
{
  std::string session_id;
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;  ///< outward
  /// What the light leaves alone: brightness against that of the surroundings, and two chromaticities; each about as
  /// large as the others matter. Zero without colour.
  std::vector<Eigen::Vector3f> colors;
  std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colors_rgb;  ///< as recorded, for people
  double spacing_m = 0;                                       ///< of the points
  std::string doubt;                             ///< why its shape may differ from the object's; empty: no reason found
  std::optional<geometry::Plane> support_plane;  ///< session frame
  std::vector<SpaceView> views;
  std::vector<ObjectFeatures> features;

  Eigen::Vector3f center() const;  ///< of the box of the points; zero without points
  double radius_m() const;         ///< farthest point from the centre
};

}  // namespace object_modelling::registration
