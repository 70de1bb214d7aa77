#pragma once

#include "object_modelling/database/object_database.h"
#include "support/synthetic_scene.h"
#include "support/temp_dir.h"

namespace object_modelling::recognition
{
/// Of the known box.
inline const Eigen::Vector3d SIZE_M(0.08, 0.12, 0.2);
constexpr std::uint32_t TEXTURE_SEED = 2;

/// T_world_camera, 0.65 m from the middle of the table.
Eigen::Isometry3d lookingAtTable(double angle_rad, double height_m);

/// A textured box, seen from all around but not from below.
database::ObjectModel boxModel();

/// The known box, turned, and an unknown one.
test_support::SyntheticScene boxBesideAnother(double yaw_rad);

/// As a Kinect gives it, without a mask.
rgbd::Frame noisyFrame(const test_support::SyntheticScene& scene, const Eigen::Isometry3d& T_world_camera);

}  // namespace object_modelling::recognition
