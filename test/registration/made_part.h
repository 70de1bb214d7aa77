#pragma once

#include <functional>
#include <initializer_list>
#include <vector>

#include "object_modelling/registration/partial_model.h"

namespace object_modelling::registration
{
inline const Eigen::Vector3f X = Eigen::Vector3f::UnitX(), Y = Eigen::Vector3f::UnitY(), Z = Eigen::Vector3f::UnitZ();
constexpr float SPACING_M = 0.002F;

using ColorAt = std::function<Eigen::Vector3f(const Eigen::Vector3f& p)>;

inline Eigen::Vector3f plain(const Eigen::Vector3f& /*p*/)
{
  return Eigen::Vector3f::Zero();
}

/// Adds a flat grid of points, from `corner` along the unit vectors u and v. Its normal is u x v.
inline void addPatch(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v, int count_u,
                     int count_v, const ColorAt& color, PartialModel* part)
{
  for (int j = 0; j < count_v; ++j)
    for (int i = 0; i < count_u; ++i)
    {
      part->points.push_back(corner + part->spacing_m * (static_cast<float>(i) * u + static_cast<float>(j) * v));
      part->normals.push_back(u.cross(v));
      part->colors.push_back(color(part->points.back()));
    }
}

inline PartialModel madePart(double spacing_m = SPACING_M)
{
  PartialModel part;
  part.spacing_m = spacing_m;
  return part;
}

/// The part in another session frame: T_session_part puts it there, with all that it knows.
inline PartialModel placed(PartialModel part, const Eigen::Isometry3f& T_session_part)
{
  for (Eigen::Vector3f& p : part.points)
    p = T_session_part * p;
  for (Eigen::Vector3f& n : part.normals)
    n = T_session_part.linear() * n;
  for (SpaceView& view : part.views)
    view.T_camera_session = view.T_camera_session * T_session_part.inverse();
  for (ObjectFeatures& features : part.features)
    for (Eigen::Vector3f& p : features.points)
      p = T_session_part * p;
  if (part.support_plane)
    part.support_plane = geometry::transformed(T_session_part.cast<double>(), *part.support_plane);
  return part;
}

inline Eigen::Isometry3f pose(const Eigen::Vector3f& t, float angle_rad, const Eigen::Vector3f& axis)
{
  return Eigen::Translation3f(t) * Eigen::AngleAxisf(angle_rad, axis.normalized());
}

/// A camera 1 m before the origin that looks along z and measured one depth everywhere.
inline SpaceView viewAlongZ(float measured_m, double axial_sigma_m = 0.001)
{
  SpaceView view;
  view.camera = { 200, 200, 200, 200, 99.5, 99.5, {} };
  view.T_camera_session.translation().z() = 1;
  view.least_depth_m = cv::Mat(200, 200, CV_32FC1, cv::Scalar(measured_m));
  view.axial_sigma_m = axial_sigma_m;
  return view;
}

}  // namespace object_modelling::registration
