#pragma once

#include <Eigen/Geometry>

namespace object_modelling::recognition
{
/// An object at a pose, before anything is known of how well it fits.
struct PoseHypothesis
{
  int object = -1;  ///< index of the known object
  Eigen::Isometry3d T_camera_model = Eigen::Isometry3d::Identity();
  int matched_features = 0;  ///< that agree on it
  float votes = 0;           ///< of pair features
};

}  // namespace object_modelling::recognition
