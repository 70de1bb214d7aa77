#pragma once

#include "support/synthetic_scene.h"

// The box of boxOnTable() recorded again, and other objects in its place.
namespace object_modelling::pipeline
{
/// Its box moved by T.
inline test_support::SyntheticScene moved(const Eigen::Isometry3d& T)
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  scene.objects[0].T_world_object = T * scene.objects[0].T_world_object;
  return scene;
}

inline Eigen::Isometry3d turned(double yaw_rad, double x_m, double y_m)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x_m, y_m, 0);
  return T;
}

/// Onto its head: its top, which was seen, is what it stands on.
inline Eigen::Isometry3d upsideDown(double yaw_rad, double height_m)
{
  Eigen::Isometry3d T = turned(yaw_rad, 0.01, 0.02);
  T.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  T.translation().z() = height_m;
  return T;
}

inline test_support::SyntheticScene withObject(const test_support::SceneObject& object)
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  scene.objects = { object };
  return scene;
}

}  // namespace object_modelling::pipeline
